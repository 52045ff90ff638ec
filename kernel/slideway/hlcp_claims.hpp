// What the HLCP solver's reasoning rests on, as conditions for SLIDEWAY_CLAIM: no other code asks them.
#pragma once

#include <slideway/hlcp_search.hpp>
#include <slideway/verify.hpp>

namespace slideway::hlcp_detail {

/// Whether x has its signs and misses each equation by at most 6 (n + 1) 2^-53 of its terms' magnitudes: 5 (n + 1)
/// 2^-53 are promised (residual_limit), and the evaluation here costs at most (n + 1) 2^-53. In the data given, so that
/// scaling is judged too; long double has room for products of any two doubles.
template <int Capacity>
inline bool is_answer(const Hlcp<Capacity>& problem, int n, const HlcpSolution<Capacity>& solution) noexcept {
  bool good = true;
  for (int i = 0; i < n; ++i) {
    long double miss = -static_cast<long double>(problem.b[i]);
    long double size = std::fabs(static_cast<long double>(problem.b[i]));
    for (int j = 0; j < n; ++j) {
      const double x = solution.x[j];
      good = good && std::isfinite(x) && solution.sign[j] == (x < 0.0 ? -1 : 1);
      const long double w = static_cast<long double>(x < 0.0 ? problem.minus[i][j] : problem.plus[i][j]);
      miss += w * static_cast<long double>(x);
      size += std::fabs(w * static_cast<long double>(x));
    }
    good = good && std::fabs(miss) <= 6.0L * (n + 1) * 0x1p-53L * size;
  }
  return good;
}

/// The sign of det W(signs), from its factors: that of the permutation times those of the pivots. W + E is factored,
/// and |W^-1| |E| < 1 says that no W + t E between them is singular: |E| <= 3 n 2^-53 |L||U| is some 2^-46 of a row's
/// size at most, and |W^-1| size below 2^22. 0 otherwise.
template <int Capacity>
inline int sign_by_factors(const Hlcp<Capacity>& problem, int n, const signed char* signs,
                           Trial<Capacity>& trial) noexcept {
  double z[Capacity];
  int sign =
      select(problem, n, signs, trial) && factor(n, trial) && reach_of(trial, n, trial.size, z) <= 0x1p22 ? 1 : 0;
  for (int k = 0; k < n && sign != 0; ++k) {
    if (trial.lu[k][k] < 0.0) sign = -sign;
    for (int i = 0; i < k; ++i)
      if (trial.row[i] > trial.row[k]) sign = -sign;
  }
  return sign;
}

/// Whether no two determinants of W(s) have opposite signs, as far as factors show: what `certified` says, by other
/// means than any of its proofs. Orders 3 to 6, 64 factorizations at most.
template <int Capacity>
inline bool has_one_sign(const Hlcp<Capacity>& problem, int n) noexcept {
  if constexpr (Capacity >= 3) {
    Trial<Capacity> trial;
    signed char signs[hlcp_max_order];
    bool positive = false;
    bool negative = false;
    for (Word code = 0; n >= 3 && n <= 6 && code < Word{1} << n; ++code) {
      signs_of(code, n, signs);
      const int sign = sign_by_factors(problem, n, signs, trial);
      positive = positive || sign > 0;
      negative = negative || sign < 0;
    }
    return !(positive && negative);
  }
  return true;
}

/// Whether no more sign patterns were examined than they may be. n <= 4: n + 4 by the short way, as many by sign
/// iteration, 2^n determinants and 2^n trials of what they found. Else as many as allowed, and once more the one that
/// enumeration has found.
inline bool within_limit(int solves, int n, int max_solves) noexcept {
  return solves <= (n <= 0 ? 0 : n <= decidable ? 2 * (n + 4) + (2 << n) : max_solves + 1);
}

}  // namespace slideway::hlcp_detail
