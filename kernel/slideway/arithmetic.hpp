// The two operations on doubles that all of the kernel shares.
#pragma once

#ifdef __clang__
#define SLIDEWAY_MAY_DIVIDE_BY_ZERO [[clang::no_sanitize("float-divide-by-zero")]]
#else
#define SLIDEWAY_MAY_DIVIDE_BY_ZERO
#endif

namespace slideway {

/// The larger of two magnitudes; b when a is NaN.
[[gnu::always_inline]] constexpr inline double larger(double a, double b) noexcept { return a > b ? a : b; }

namespace detail {

/// a / b where b may be zero: IEEE 754's infinity or NaN, on which what follows decides. In C++ alone that is
/// undefined, so UndefinedBehaviorSanitizer (float-divide-by-zero) is told here, and only here, that it is meant.
SLIDEWAY_MAY_DIVIDE_BY_ZERO [[gnu::always_inline]] constexpr inline double quotient(double a, double b) noexcept {
  return a / b;
}

}  // namespace detail
}  // namespace slideway
