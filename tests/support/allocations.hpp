// Counts what a piece of code asks of the heap.
#pragma once

#include <cstddef>

namespace slideway::test {

/// Whether allocations() counts here: glibc, and no sanitizer that has its own malloc. A test that needs it skips
/// otherwise.
bool allocations_are_counted() noexcept;

/// Calls of malloc, calloc, realloc, aligned_alloc, memalign and posix_memalign by this thread so far; operator new and
/// Eigen's aligned memory are among them, since they call these. The difference of two values is what lies between.
std::size_t allocations() noexcept;

}  // namespace slideway::test
