#include "support/allocations.hpp"

#include <cerrno>
#include <cstdlib>

#ifdef __has_feature
#define SLIDEWAY_HAS_FEATURE(feature) __has_feature(feature)
#else
#define SLIDEWAY_HAS_FEATURE(feature) 0
#endif

#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    SLIDEWAY_HAS_FEATURE(address_sanitizer) || SLIDEWAY_HAS_FEATURE(memory_sanitizer) ||    \
    SLIDEWAY_HAS_FEATURE(thread_sanitizer)

namespace slideway::test {
bool allocations_are_counted() noexcept { return false; }
std::size_t allocations() noexcept { return 0; }
}  // namespace slideway::test

#else

namespace {
// Initial-exec: the first access must not itself allocate.
[[gnu::tls_model("initial-exec")]] thread_local std::size_t count = 0;
}  // namespace

namespace slideway::test {
bool allocations_are_counted() noexcept { return true; }
std::size_t allocations() noexcept { return count; }
}  // namespace slideway::test

// The program's own definitions come before the C library's, for its shared libraries too; glibc keeps its own under
// these names. What they return is glibc's, so free stays as it is.
extern "C" {
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t number, std::size_t size) noexcept;
void* __libc_realloc(void* old, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;

void* malloc(std::size_t size) noexcept {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  ++count;
  return __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  ++count;
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++count;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** result, std::size_t alignment, std::size_t size) noexcept {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* const memory = memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *result = memory;
  return 0;
}
}

#endif
