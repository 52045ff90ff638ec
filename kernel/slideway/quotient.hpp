// Quotients whose divisor may be zero: IEEE 754's infinity or NaN, on which what follows decides. In C++ alone that is
// undefined, so UndefinedBehaviorSanitizer (float-divide-by-zero) is told here, and only here, that it is meant.
#pragma once

#ifdef __clang__
#define SLIDEWAY_MAY_DIVIDE_BY_ZERO [[clang::no_sanitize("float-divide-by-zero")]]
#else
#define SLIDEWAY_MAY_DIVIDE_BY_ZERO
#endif

namespace slideway::detail {

SLIDEWAY_MAY_DIVIDE_BY_ZERO [[gnu::always_inline]] constexpr inline double quotient(double a, double b) noexcept {
  return a / b;
}

}  // namespace slideway::detail
