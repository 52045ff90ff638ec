// How deep a call goes into the stack.
#pragma once

#include <cstddef>
#include <functional>

namespace slideway::charts {

/// Bytes of stack that a call takes: run in a thread whose stack was filled with a pattern, and read where that is
/// left; less what a call that does nothing takes there.
std::size_t stack_of(const std::function<void()>& call);

}  // namespace slideway::charts
