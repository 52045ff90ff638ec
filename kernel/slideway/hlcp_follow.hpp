// A+ x+ - A- x- = b with the signs of x given, right or wrong: one linear solve. What a step does inside a mode.
#pragma once

#include <slideway/hlcp.hpp>

namespace slideway {

/// x with W(signs) x = b, of order n, a std::integral_constant<int, N> or an int, 1 <= n <= Capacity. False when the
/// matrix is singular or the residual is beyond that of `solve`; for n <= 2, where whoever asks has to look at x, only
/// when x is not finite. One factorization; signs of x may contradict those given.
template <int Capacity, class Count>
inline bool solve_with_signs(const Hlcp<Capacity>& problem, Count n, const signed char* signs, double* x) noexcept {
  using namespace hlcp_detail;
  if (n == 1) {
    x[0] = detail::quotient(problem.b[0], signs[0] == -1 ? problem.minus[0][0] : problem.plus[0][0]);
    return std::isfinite(x[0]);
  }
  if constexpr (Capacity >= 2) {
    if (n == 2) {
      const PairBits mask = {static_cast<long long>(mask_of(signs[0])), static_cast<long long>(mask_of(signs[1]))};
      const Pair found = solve_two(choose(gather(problem.plus[0]), gather(problem.minus[0]), mask),
                                   choose(gather(problem.plus[1]), gather(problem.minus[1]), mask), row_sizes(problem),
                                   gather(problem.b));
      x[0] = found[0];
      x[1] = found[1];
      return std::isfinite(found[0] + found[1]);
    }
  }
  if constexpr (Capacity >= 3) {
    Trial<Capacity> trial;
    if (!attempt_many(problem, n, signs, trial)) return false;
    for (int k = 0; k < n; ++k) x[k] = trial.x[k];
    return true;
  }
  return false;
}

}  // namespace slideway
