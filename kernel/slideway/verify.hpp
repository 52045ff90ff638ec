// The kernel's own claims, checked where SLIDEWAY_VERIFY is defined and absent otherwise: loop invariants and bounds
// that a proof in a comment states and that nothing at run time needs. The tests under sanitizers and the fuzz targets
// are built with it (CMake: -D SLIDEWAY_VERIFY=ON).
#pragma once

#ifdef SLIDEWAY_VERIFY

#include <cstdio>
#include <cstdlib>

namespace slideway::detail {

[[noreturn]] inline void claim_failed(const char* claim, const char* file, int line) noexcept {
  std::fprintf(stderr, "slideway: %s:%d: what should always hold does not: %s\n", file, line, claim);
  std::abort();
}

}  // namespace slideway::detail

/// Ends the program, with the claim and its place, where the claim does not hold. The claim has no side effects.
#define SLIDEWAY_CLAIM(...) \
  ((__VA_ARGS__) ? static_cast<void>(0) : ::slideway::detail::claim_failed(#__VA_ARGS__, __FILE__, __LINE__))

#else

#define SLIDEWAY_CLAIM(...) static_cast<void>(0)

#endif
