// Proofs that a problem has one solution for every b: the column W-property, from the factors of one trial.
#pragma once

#include <slideway/hlcp_trial.hpp>

namespace slideway::hlcp_detail {

/// Room for the roundings in the bound itself, at most 6 n + 6 of them.
inline constexpr double contracting = 1.0 - 0x1p-20;

/// The rounding errors |L U - P W| of a row are at most this times its size: 3 n 2^-53 sum_k |l_ik| sum_j |u_kj|, where
/// weighted |l_ik| is at most 1.
template <int Capacity>
inline double lu_error(const Trial<Capacity>& trial, int n) noexcept {
  double sum = 0.0;
  for (int k = 0; k < n; ++k)
    for (int j = k; j < n; ++j) sum += std::fabs(trial.lu[k][j]) * trial.weight[k];
  return 3.0 * n * 0x1p-53 * sum;
}

/// z = M(U)^-1 M(L)^-1 P v, an upper bound of |W^-1| v for v >= 0; returns its largest component. n^2 multiplications.
/// Row by row, the newest component last: only one multiplication and one addition wait for it.
template <int Capacity, class Count>
inline double reach_of(const Trial<Capacity>& trial, Count n, const double* v, double* z) noexcept {
  double y[Capacity];
  double newest = 0.0;
  const auto forward_row = [&](int i) __attribute__((always_inline)) {
    const auto& l = trial.lu[i];
    Pair pairs = {v[trial.row[i]], 0.0};
    for (int k = 0; k + 2 < i; k += 2) pairs += magnitude(load(&l[k])) * gather(&y[k]);
    double sum = pairs[0] + pairs[1];
    if (i >= 2 && i % 2 == 0) sum += std::fabs(l[i - 2]) * y[i - 2];
    if (i >= 1) sum += std::fabs(l[i - 1]) * newest;
    y[i] = newest = sum;
  };
  each(n, forward_row);
  double largest = 0.0;
  const auto backward_row = [&](int solved) __attribute__((always_inline)) {
    const int i = n - 1 - solved;
    const auto& u = trial.lu[i];
    Pair pairs = {y[i], 0.0};
    for (int j = n - 2; j >= i + 2; j -= 2) pairs += magnitude(gather(&u[j])) * gather(&z[j]);
    double sum = pairs[0] + pairs[1];
    if (solved >= 2 && solved % 2 == 0) sum += std::fabs(u[i + 2]) * z[i + 2];
    const double inverse = std::fabs(trial.inverse[i]);
    sum *= inverse;
    if (solved >= 1) sum += (std::fabs(u[i + 1]) * inverse) * newest;
    z[i] = newest = sum;
    largest = sum > largest ? sum : largest;
  };
  each(n, backward_row);
  return largest;
}

/// v = (|A+ - A-| + allowance) u for 0 <= u <= 1.
template <int Capacity, class Count>
inline void perturb(const Hlcp<Capacity>& problem, Count n, const Trial<Capacity>& trial, const double* u,
                    double* v) noexcept {
  for (int i = 0; i < n; ++i) {
    Pair sum = {allowance * trial.size[i], 0.0};
    for (int j = 0; j + 1 < n; j += 2)
      sum += magnitude(load(&problem.plus[i][j]) - load(&problem.minus[i][j])) * gather(&u[j]);
    if (n % 2 != 0) sum[1] += std::fabs(problem.plus[i][n - 1] - problem.minus[i][n - 1]) * u[n - 1];
    v[i] = sum[0] + sum[1];
  }
}

/// Whether |W^-1| (|A+ - A-| + allowance) u < u for some u > 0, so that no matrix between A+ and A- is singular
/// (spectral radius below 1: Rohn) and the W-property holds: u = 1 was tried with the solve, here follow two steps of
/// power iteration. O(n^2) each. If a step increases every component no u can do (Collatz-Wielandt).
template <int Capacity, class Count>
inline bool contracts(const Hlcp<Capacity>& problem, Count n, const Trial<Capacity>& trial) noexcept {
  if (n > 16 && !(lu_error(trial, n) <= 0.5 * allowance)) return false;  // to 16, growth of 2^(n-1) is allowed
  if (trial.reach <= contracting) return true;
  double u[Capacity];
  double z[Capacity];
  double v[Capacity];
  for (int i = 0; i < n; ++i) {
    u[i] = 1.0;
    z[i] = trial.side[i][1];
  }
  double largest = trial.reach;
  for (int step = 0; step < 2; ++step) {
    bool hopeless = true;
    for (int i = 0; i < n && hopeless; ++i) hopeless = z[i] >= u[i];
    if (hopeless || !(largest < HUGE_VAL)) return false;
    const double unit = 1.0 / largest;
    for (int i = 0; i < n; ++i) u[i] = z[i] * unit;
    perturb(problem, n, trial, u, v);
    largest = reach_of(trial, n, v, z);
    bool below = true;
    for (int i = 0; i < n && below; ++i) below = z[i] <= contracting * u[i];
    if (below) return true;
  }
  return false;
}

/// Whether all determinants of W(s), n = 3 or 4, have one strict sign beyond rounding errors, 8 2^-53 times the product
/// of the row sizes: the column W-property (Sznajder & Gowda 1995).
template <int Capacity, class Count>
inline bool determinants_agree(const Hlcp<Capacity>& problem, Count n, const Trial<Capacity>& trial) noexcept {
  double size = 1.0;
  for (int i = 0; i < n; ++i) size *= trial.size[i];
  return least_determinant(problem, n) > 0x1p-48 * size;
}

/// Whether uniqueness is proved for the trial of clear signs: by contraction; for n <= 4, if the first step does not
/// do, by the determinants, where it must be shown separately that x owes no sign to rounding (see tie_window).
template <int Capacity, class Count>
inline bool proves(const Hlcp<Capacity>& problem, Count n, const Trial<Capacity>& trial) noexcept {
  if (n > most_by_cofactors) return contracts(problem, n, trial);
  if (trial.reach <= contracting) return true;
  double z[Capacity];
  return (trial.cofactors || reach_of(trial, n, trial.size, z) <= 0x1p22) && determinants_agree(problem, n, trial);
}

}  // namespace slideway::hlcp_detail
