// One trial of a sign pattern s: the linear solve W(s) x = b, and everything that follows from it: signs, residual,
// uniqueness.
#pragma once

#include <slideway/hlcp_cofactors.hpp>
#include <slideway/verify.hpp>

namespace slideway::hlcp_detail {

/// A component below 2^-20 of the largest may owe its sign to rounding; then the signs are decided anew from a start
/// that the data alone determine. Why 2^-20: the proofs of uniqueness show |W^-1| R <= 2^22 for every matrix W between
/// A+ and A-, R the row sizes, and two vectors with the residual allowed differ by at most 2 * 5 (n + 1) 2^-53 * 2 *
/// 2^22 max|x| <= 2^-20.6 max|x| for n <= 64. A wider window costs solves, a narrower one bits.
inline constexpr double tie_window = 0x1p-20;

/// One sign pattern: W(s), its factors, and what follows from them.
template <int Capacity>
struct Trial {
  static constexpr int stride = Capacity + Capacity % 2;  // everything goes in pairs; the odd one out is zero
  alignas(16) double w[Capacity][stride];                 // W(s)
  alignas(16) double lu[Capacity][stride];                // L below, U on and above the diagonal, rows as in `row`
  alignas(16) double side[Capacity][2];                   // right side | bound: L and U act on both, in two lanes
  alignas(16) double x[stride];
  // Of row i in W(s), and at least that in every other pattern: sum_j |w_ij| + |a+_ij - a-_ij|.
  alignas(16) double size[stride];
  // 2^-exponent(size), in the order `row`: equilibrates rows in comparisons, never in the data.
  alignas(16) double weight[stride];
  double inverse[Capacity];  // of the pivots
  int row[Capacity];
  double reach;     // max of the bound on |W^-1| (|A+ - A-| + allowance * size) 1
  double residual;  // largest componentwise relative backward error
  bool cofactors;   // x came by cofactors: L and U have not been made
  bool regular;     // no pivot is lost in rounding errors
  bool accurate;    // residual within its limit
};

/// The limit for the residual as computed. Gaussian elimination with one step of refinement in working precision
/// reaches 2 (n + 1) 2^-53 (Skeel 1980; Higham 2002, theorem 12.4), the evaluation adds (n + 1) 2^-53, one more of
/// these is slack. The true residual is then within 5 (n + 1) 2^-53.
inline double residual_limit(int n) noexcept { return 4.0 * (n + 1) * 0x1p-53; }

/// Of the row sizes, added to the perturbation that the proof of uniqueness covers: half of it pays for the errors of L
/// and U, half shows |W^-1| R <= 2^22 (see tie_window).
inline constexpr double allowance = 0x1p-21;

/// The largest order that is first tried by cofactors; L and U of W are made only when they are needed.
inline constexpr int most_by_cofactors = 4;

/// Row i of W(signs) into w, above that order into lu too; returns sum_j |w_ij| and sum_j |a+_ij - a-_ij|, each in two
/// lanes.
template <int Capacity, class Count>
[[gnu::always_inline]] inline void select_row(const Hlcp<Capacity>& problem, Count n, int i, const PairBits* minus,
                                              Trial<Capacity>& trial, Pair& entries, Pair& spread) noexcept {
  entries = spread = Pair{0.0, 0.0};
  for (int j = 0; j < n; j += 2) {
    const bool last = j + 1 == n;
    const Pair p = last ? Pair{problem.plus[i][j], 0.0} : load(&problem.plus[i][j]);
    const Pair m = last ? Pair{problem.minus[i][j], 0.0} : load(&problem.minus[i][j]);
    const Pair w = choose(p, m, minus[j / 2]);
    store(&trial.w[i][j], w);
    if (n > most_by_cofactors) store(&trial.lu[i][j], w);
    entries += magnitude(w);
    spread += magnitude(p - m);
  }
}

/// The weight and the place of a row, two rows at a time, before elimination.
template <int Capacity>
[[gnu::always_inline]] inline void line_up(Trial<Capacity>& trial, int i, int next) noexcept {
  const PairBits exponent = (PairBits)load(&trial.size[i]) & exponent_bits;
  store(&trial.weight[i], (Pair)(twice_bias - exponent));
  trial.row[i] = i;
  trial.row[next] = next;
}

/// Fills w, side and size for W(signs), and above most_by_cofactors what elimination needs, two rows at a time. Returns
/// false when a row is out of the range where nothing overflows. (A right side that is not finite shows in the
/// residual.)
template <int Capacity, class Count>
inline bool select(const Hlcp<Capacity>& problem, Count n, const signed char* signs, Trial<Capacity>& trial) noexcept {
  PairBits minus[Trial<Capacity>::stride / 2];
  for (int j = 0; j < n; j += 2)
    minus[j / 2] =
        PairBits{-static_cast<long long>(signs[j] == -1), j + 1 < n ? -static_cast<long long>(signs[j + 1] == -1) : 0};
  double total = 0.0;
  double least = HUGE_VAL;
  for (int i = 0; i < n; i += 2) {
    const int next = i + 1 < n ? i + 1 : i;  // the last row of an odd order goes with itself
    Pair entries[2];
    Pair spread[2];
    select_row(problem, n, i, minus, trial, entries[0], spread[0]);
    select_row(problem, n, next, minus, trial, entries[1], spread[1]);
    const Pair perturbation = sums(spread[0], spread[1]);
    const Pair size = perturbation + sums(entries[0], entries[1]);
    const Pair bound = perturbation + Pair{allowance, allowance} * size;
    store(&trial.size[i], size);
    if (n > most_by_cofactors) line_up(trial, i, next);
    store(trial.side[i], Pair{problem.b[i], bound[0]});
    store(trial.side[next], Pair{problem.b[next], bound[1]});
    total += size[0] + size[1];
    least = size[0] < least ? size[0] : least;
    least = size[1] < least ? size[1] : least;
  }
  return total <= 0x1p200 && least >= 0x1p-200;
}

/// What a pivot's key keeps for its row, the last six bits: magnitudes that agree to 2^-46 are ties.
inline constexpr Word row_bits = hlcp_max_order - 1;
static_assert((hlcp_max_order & (hlcp_max_order - 1)) == 0, "a power of two");

/// The row with the largest weighted entry in column k, rows k and below, and that entry: bits of magnitudes compare
/// like numbers, the last ones carry the row, so that one integer maximum finds both and ties go to the first row.
template <int Capacity, class Count>
inline Word pivot_in(const Trial<Capacity>& trial, int k, Count n) noexcept {
  Word best = 0;
  for (int i = k; i < n; ++i) {
    const Word size = bits(trial.lu[i][k] * trial.weight[i]) & ~sign_bit;
    const Word key = (size & ~row_bits) | (row_bits - static_cast<Word>(i));
    best = key > best ? key : best;
  }
  return best;
}

template <int Capacity, class Count>
inline void exchange(Trial<Capacity>& trial, int k, int p, Count n) noexcept {
  for (int j = 0; j < n; j += 2) {
    const Pair upper = load(&trial.lu[k][j]);
    store(&trial.lu[k][j], load(&trial.lu[p][j]));
    store(&trial.lu[p][j], upper);
  }
  const Pair side = load(trial.side[k]);
  store(trial.side[k], load(trial.side[p]));
  store(trial.side[p], side);
  std::swap(trial.weight[k], trial.weight[p]);
  std::swap(trial.row[k], trial.row[p]);
}

/// P W = L U by row updates (no sum crosses lanes: the same bits for every vector width), the forward solves of both
/// sides with it: side <- (L^-1 P b, M(L)^-1 P bound), M() the comparison matrix, |L^-1| <= M(L)^-1 (Higham 2002,
/// section 8.2). Returns the least weighted pivot; stops at one that is zero. n^3/3 multiplications.
template <int Capacity, class Count>
inline double eliminate(Trial<Capacity>& trial, Count n) noexcept {
  Word least = bits(4.0);
  const auto pivot_step = [&](int k) __attribute__((always_inline)) {
    const Word best = pivot_in(trial, k, n);
    const int p = static_cast<int>(row_bits - (best & row_bits));
    least = best < least ? best : least;
    if (p != k) exchange(trial, k, p, n);
    const double inverse = detail::quotient(1.0, trial.lu[k][k]);
    trial.inverse[k] = inverse;
    const Pair side = load(trial.side[k]);
    for (int i = k + 1; i < n; ++i) {
      const double l = trial.lu[i][k] * inverse;
      for (int j = (k + 1) & ~1; j < n; j += 2)
        store(&trial.lu[i][j], load(&trial.lu[i][j]) - Pair{l, l} * load(&trial.lu[k][j]));
      trial.lu[i][k] = l;
      store(trial.side[i], load(trial.side[i]) - comparison(l) * side);
    }
  };
  each(n, pivot_step);
  return real(least & ~row_bits);
}

/// For SLIDEWAY_CLAIM, O(n^3): whether L U = P W but for 3 n 2^-53 |L||U|, as all error bounds here take it (Higham
/// 2002, theorem 9.3: n, and 2 more for multiplying by a rounded inverse), and for what underflows, 2^-1074 in L times
/// entries below 2^200 2^n in U; and whether weighted |l_ik| is at most 1, but for the 2^-46 that pivots of one size
/// may differ by, and roundings.
template <int Capacity>
inline bool reproduces(const Trial<Capacity>& trial, int n) noexcept {
  bool good = true;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k)
      good = good && std::fabs(trial.lu[i][k]) * trial.weight[i] <= (1.0 + 0x1p-44) * trial.weight[k];
    for (int j = 0; j < n; ++j) {
      double sum = -trial.w[trial.row[i]][j];
      double size = 0.0;
      for (int k = 0; k <= i && k <= j; ++k) {
        const double term = (k == i ? 1.0 : trial.lu[i][k]) * trial.lu[k][j];
        sum += term;
        size += std::fabs(term);
      }
      // The sum itself has at most n + 1 roundings of terms below |L||U| + |W| <= 3 |L||U|.
      good = good && std::fabs(sum) <= (3.0 * n + 3.0 * (n + 1)) * 0x1p-53 * size + 0x1p-800;
    }
  }
  return good;
}

/// x = U^-1 side, and in the other lane reach = max M(U)^-1 bound.
template <int Capacity, class Count>
inline void substitute(Trial<Capacity>& trial, Count n) noexcept {
  double reach = 0.0;
  trial.x[n - 1 + n % 2] = 0.0;  // the odd one out, which no solve sets; else the last, which is set below
  const auto back_step = [&](int solved) __attribute__((always_inline)) {
    const int j = n - 1 - solved;
    const double inverse = trial.inverse[j];
    const Pair value = load(trial.side[j]) * Pair{inverse, std::fabs(inverse)};
    store(trial.side[j], value);
    trial.x[j] = value[0];
    reach = value[1] > reach ? value[1] : reach;
    for (int i = 0; i < j; ++i) store(trial.side[i], load(trial.side[i]) - comparison(trial.lu[i][j]) * value);
  };
  each(n, back_step);
  trial.reach = reach;
}

/// Whether a row whose terms are all below 2^-900 is one of zeros, so that no residual was lost to underflow.
template <int Capacity>
inline bool vanishes(const Hlcp<Capacity>& problem, const Trial<Capacity>& trial, int i, int n) noexcept {
  bool zero = problem.b[i] == 0.0;
  for (int j = 0; j < n; ++j) zero = zero && (trial.w[i][j] == 0.0 || trial.x[j] == 0.0);
  return zero;
}

/// W x and |W||x| in row i, each in two lanes.
template <int Capacity, class Count>
[[gnu::always_inline]] inline void product_row(const Trial<Capacity>& trial, Count n, int i, Pair& sum,
                                               Pair& size) noexcept {
  sum = size = Pair{0.0, 0.0};
  for (int j = 0; j < n; j += 2) {
    const Pair term = load(&trial.w[i][j]) * gather(&trial.x[j]);
    sum += term;
    size += magnitude(term);
  }
}

/// residual = max_i |W x - b|_i / (|W||x| + |b|)_i, and whether it is within its limit; two rows at a time. False for
/// anything not finite.
template <int Capacity, class Count>
inline void check(const Hlcp<Capacity>& problem, Count n, Trial<Capacity>& trial) noexcept {
  double worst = 0.0;
  double total = 0.0;  // shows a ratio that is no number
  bool lost = false;
  for (int i = 0; i < n; i += 2) {
    const int next = i + 1 < n ? i + 1 : i;
    Pair sum[2];
    Pair size[2];
    product_row(trial, n, i, sum[0], size[0]);
    product_row(trial, n, next, sum[1], size[1]);
    const Pair b = {problem.b[i], problem.b[next]};
    Pair scale = sums(size[0], size[1]) + magnitude(b);
    if (__builtin_expect(!(scale[0] >= 0x1p-900 && scale[1] >= 0x1p-900), 0)) {
      const bool zero[2] = {vanishes(problem, trial, i, n), vanishes(problem, trial, next, n)};
      lost = lost || !(zero[0] || scale[0] >= 0x1p-900) || !(zero[1] || scale[1] >= 0x1p-900);
      scale = Pair{zero[0] ? 1.0 : scale[0], zero[1] ? 1.0 : scale[1]};
    }
    const Pair ratio = magnitude(sums(sum[0], sum[1]) - b) / scale;
    total += ratio[0] + ratio[1];
    worst = ratio[0] > worst ? ratio[0] : worst;
    worst = ratio[1] > worst ? ratio[1] : worst;
  }
  trial.residual = worst;
  trial.accurate = !lost && total <= 2.0 * hlcp_max_order && worst <= residual_limit(n);
}

/// The rounding error of the product a*b (Dekker 1971). Exact for |a|, |b| < 2^996 unless the error underflows.
inline double product_error(double a, double b) noexcept {
  const double split = 0x1p27 + 1.0;
  const double a_big = split * a - (split * a - a);
  const double b_big = split * b - (split * b - b);
  const double a_low = a - a_big;
  const double b_low = b - b_big;
  return ((a_big * b_big - a * b) + a_big * b_low + a_low * b_big) + a_low * b_low;
}

/// b - W x as if in twice the working precision (Ogita, Rump & Oishi 2005, Dot2).
template <int Capacity>
inline void residual(const Hlcp<Capacity>& problem, int n, const Trial<Capacity>& trial, double* rest) noexcept {
  for (int i = 0; i < n; ++i) {
    double sum = problem.b[i];
    double error = 0.0;
    for (int j = 0; j < n; ++j) {
      const double term = -(trial.w[i][j] * trial.x[j]);
      const double next = sum + term;
      const double shadow = next - sum;
      error += ((sum - (next - shadow)) + (term - shadow)) - product_error(trial.w[i][j], trial.x[j]);
      sum = next;
    }
    rest[i] = sum + error;
  }
}

/// Whether every pivot exceeds its own rounding errors, n 2^-52 (|L||U|)_kk: a test that scaling rows or columns does
/// not change.
template <int Capacity>
inline bool pivots_sound(const Trial<Capacity>& trial, int n) noexcept {
  for (int k = 0; k < n; ++k) {
    double formed = std::fabs(trial.lu[k][k]);
    const double pivot = formed;
    for (int j = 0; j < k; ++j) formed += std::fabs(trial.lu[k][j] * trial.lu[j][k]);
    if (!(pivot > n * 0x1p-52 * formed)) return false;
  }
  return true;
}

/// Whether x has the signs and no component is near a tie: every s_k x_k exceeds tie_window * max |x| (or x = 0). NaN
/// shows in the residual.
template <class Count>
inline bool clear(const double* x, Count n, const signed char* signs) noexcept {
  double largest = 0.0;
  double least = HUGE_VAL;
  for (int k = 0; k < n; ++k) {
    const double along = real(bits(x[k]) ^ (static_cast<Word>(signs[k] == -1) << 63));
    const double size = std::fabs(x[k]);
    largest = size > largest ? size : largest;
    least = along < least ? along : least;
  }
  return least > tie_window * largest || largest == 0.0;
}

/// x += W^-1 rest for n = 1 and n = 2.
template <int Capacity>
inline void correct_small(const Hlcp<Capacity>& problem, int n, const double* rest, Trial<Capacity>& trial) noexcept {
  if constexpr (Capacity >= 2) {
    if (n == 2) {
      const Pair b = {rest[0], rest[1]};
      const Pair change = solve_two(load(trial.w[0]), load(trial.w[1]), row_sizes(problem), b);
      trial.x[0] += change[0];
      trial.x[1] += change[1];
      return;
    }
  }
  trial.x[0] += detail::quotient(rest[0], trial.w[0][0]);
}

/// L and U of the W that select() has put in place, n >= 3, and with them the forward solves of `side`; whether W is
/// regular.
template <int Capacity, class Count>
inline bool factor(Count n, Trial<Capacity>& trial) noexcept {
  for (int i = 0; i < n && n <= most_by_cofactors; i += 2) {
    const int next = i + 1 < n ? i + 1 : i;
    std::memcpy(trial.lu[i], trial.w[i], sizeof trial.w[i]);
    std::memcpy(trial.lu[next], trial.w[next], sizeof trial.w[next]);
    line_up(trial, i, next);
  }
  trial.cofactors = false;
  const double least = eliminate(trial, n);
  // Up to n = 16 growth is at most 2^16, so errors stay below 16 * 2^-52 * 2^17 < 2^-26.
  trial.regular = (n <= 16 && least >= 0x1p-26) || (least >= 0x1p-900 && pivots_sound(trial, n));
  SLIDEWAY_CLAIM(!trial.regular || reproduces(trial, n));
  return trial.regular;
}

/// x += W^-1 rest, for n >= 3 by L and U.
template <int Capacity>
inline void correct(const Hlcp<Capacity>& problem, int n, const double* rest, Trial<Capacity>& trial) noexcept {
  if (n <= 2) return correct_small(problem, n, rest, trial);
  if constexpr (Capacity >= 3)
    if (trial.cofactors) factor(n, trial);
  SLIDEWAY_CLAIM(trial.regular);
  double change[Capacity] = {};
  for (int i = 0; i < n; ++i) change[i] = rest[trial.row[i]];
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) change[i] -= trial.lu[i][k] * change[k];
  for (int j = n - 1; j >= 0; --j) {
    change[j] *= trial.inverse[j];
    for (int i = 0; i < j; ++i) change[i] -= trial.lu[i][j] * change[j];
    trial.x[j] += change[j];
  }
}

/// One step of iterative refinement; it depends on the data and the signs alone. Seldom called.
template <int Capacity>
[[gnu::noinline]] inline void refine(const Hlcp<Capacity>& problem, int n, Trial<Capacity>& trial) noexcept {
  double rest[Capacity] = {};
  residual(problem, n, trial, rest);
  correct(problem, n, rest, trial);
  check(problem, n, trial);
}

/// Solves with W(signs), n = 1 and n = 2, by the formulas that solve_one and solve_pair use, so that the bits agree.
template <int Capacity>
inline bool attempt_small(const Hlcp<Capacity>& problem, int n, const signed char* signs,
                          Trial<Capacity>& trial) noexcept {
  trial.regular = trial.accurate = false;
  if (!select(problem, n, signs, trial)) return false;
  const auto& w = trial.w;
  double det = w[0][0];
  double formed = 0.0;
  if constexpr (Capacity >= 2) {
    if (n == 2) {
      det = w[0][0] * w[1][1] - w[1][0] * w[0][1];
      formed = std::fabs(w[0][0] * w[1][1]) + std::fabs(w[1][0] * w[0][1]);
    }
  }
  trial.regular = std::fabs(det) > 2.0 * 0x1p-52 * formed && std::fabs(det) >= 0x1p-900;
  if (!trial.regular) return false;
  for (double& component : trial.x) component = 0.0;
  correct_small(problem, n, problem.b, trial);
  check(problem, n, trial);
  if (!trial.accurate) refine(problem, n, trial);
  return trial.accurate;
}

/// For |det W| from this times the product of the row sizes on, cofactors give x. |W^-1| R <= 4 * 2^20 then (see
/// tie_window), and the reach that they give is off by less than 4 (5 + 8) 2^-53 2^20 < 2^-27 while it is at most 1.
inline constexpr double well_conditioned = 0x1p-20;

/// Solves with W, n = 3 or 4, by cofactors: x, not yet checked, and reach. False where W is not well conditioned. Not
/// regular where x is made of products that may have underflowed, as those of rows near 2^-200 do; scaled, they do not.
template <int Capacity, class Count>
[[gnu::always_inline]] inline bool solve_by_cofactors(Count n, Trial<Capacity>& trial) noexcept {
  const Adjugate adjugate = adjugate_of(trial.w, n);
  double size = trial.size[0] * trial.size[1] * trial.size[2];
  Column b = {Pair{trial.side[0][0], trial.side[2][0]}, Pair{trial.side[1][0], 0.0}};
  Column bound = {Pair{trial.side[0][1], trial.side[2][1]}, Pair{trial.side[1][1], 0.0}};
  if constexpr (Capacity >= 4) {
    if (n == 4) {
      size *= trial.size[3];
      b.odd[1] = trial.side[3][0];
      bound.odd[1] = trial.side[3][1];
    }
  }
  trial.cofactors = std::fabs(adjugate.determinant) >= well_conditioned * size;
  if (!trial.cofactors) return false;
  const Column(&row)[4] = adjugate.row;
  const Column numerators = {products(row[0], row[1], b), products(row[2], row[3], b)};
  trial.regular = largest_of(magnitude(numerators)) >= 0x1p-900 || largest_of(magnitude(b)) == 0.0;
  const double inverse = detail::quotient(1.0, adjugate.determinant);
  store(&trial.x[0], numerators.even * Pair{inverse, inverse});
  store(&trial.x[2], numerators.odd * Pair{inverse, inverse});
  const Column bounds = {products(magnitude(row[0]), magnitude(row[1]), bound),
                         products(magnitude(row[2]), magnitude(row[3]), bound)};
  trial.reach = largest_of(bounds) * std::fabs(inverse);
  return true;
}

/// Solves with W(signs), n >= 3: x, not yet checked, and reach. Returns whether data in range gave a regular matrix.
template <int Capacity, class Count>
inline bool solve_unchecked(const Hlcp<Capacity>& problem, Count n, const signed char* signs,
                            Trial<Capacity>& trial) noexcept {
  trial.regular = trial.accurate = false;
  if (!select(problem, n, signs, trial)) return false;
  if (n <= most_by_cofactors && solve_by_cofactors(n, trial)) return trial.regular;
  if (!factor(n, trial)) return false;
  substitute(trial, n);
  return true;
}

/// Solves with W(signs), n >= 3. Returns whether data in range gave a regular matrix and an accurate x.
template <int Capacity, class Count>
inline bool attempt_many(const Hlcp<Capacity>& problem, Count n, const signed char* signs,
                         Trial<Capacity>& trial) noexcept {
  if (!solve_unchecked(problem, n, signs, trial)) return false;
  check(problem, n, trial);
  if (!trial.accurate) refine(problem, static_cast<int>(n), trial);
  return trial.accurate;
}

/// The same for n >= 1.
template <int Capacity, class Count>
inline bool attempt(const Hlcp<Capacity>& problem, Count n, const signed char* signs, Trial<Capacity>& trial) noexcept {
  if constexpr (Capacity >= 3)
    if (n >= 3) return attempt_many(problem, n, signs, trial);
  return attempt_small(problem, n, signs, trial);
}

}  // namespace slideway::hlcp_detail
