// The horizontal linear complementarity problem A+ x+ - A- x- = b, solved and certified. Usable on its own.
//
// For a sign vector s the matrix W(s) has column j of A+ where s_j > 0 and of A- where s_j < 0; x solves the problem
// iff W(s) x = b and s_j x_j >= 0 for some s. One trial is one linear solve with W(s), and everything that follows from
// it: signs, residual, uniqueness. The answer always is the trial of the final signs, so how they were found changes no
// bit of it.
//
//   hlcp_problem.hpp   what is asked and answered      hlcp_unique.hpp   proofs that there is one solution
//   hlcp_pairs.hpp     what it computes with           hlcp_decide.hpp   n <= 4 decided exactly
//   hlcp_cofactors.hpp orders 2 to 4 by determinants   hlcp_search.hpp   which signs to try next
//   hlcp_trial.hpp     one trial                       hlcp_claims.hpp   what holds of each, for SLIDEWAY_CLAIM
//   here               the short ways for n = 1 and 2, and the interface
#pragma once

#include <slideway/hlcp_claims.hpp>
#include <slideway/hlcp_search.hpp>
#include <type_traits>

namespace Eigen {
template <class Derived>
class MatrixBase;
template <class Scalar, int Rows, int Cols, int Options, int MaxRows, int MaxCols>
class Matrix;
}  // namespace Eigen

namespace slideway {

namespace hlcp_detail {

inline constexpr Word infinite = Word{2047} << 52;

/// Whether the magnitude with these bits is in [low, high], both as bits.
inline bool is_within(Word value, Word low, Word high) noexcept { return (value & ~sign_bit) - low <= high - low; }

/// n = 1: a quotient. The W-property is that A+ and A- have one sign, and then b decides the sign of x.
template <int Capacity>
inline void solve_one(const Hlcp<Capacity>& problem, HlcpSolution<Capacity>& solution, HlcpOptions options) noexcept {
  const Word p = bits(problem.plus[0][0]);
  const Word m = bits(problem.minus[0][0]);
  const double b = problem.b[0];
  const Word negative = Word{0} - ((p ^ bits(b)) >> 63);
  const double w = real(p ^ ((p ^ m) & negative));
  const double x = detail::quotient(b, w) + 0.0;
  // One sign, neither 0 nor infinite nor NaN; x normal, so that the quotient is correctly rounded, or exactly 0.
  const bool usual = ((p ^ m) >> 63) == 0 && is_within(p, 1, infinite - 1) && is_within(m, 1, infinite - 1) &&
                     (is_within(bits(x), bits(0x1p-1022), infinite - 1) || b == 0.0);
  if (__builtin_expect(!usual, 0)) return solve_with_care(problem, 1, solution, options, 0);
  solution.x[0] = x;
  solution.sign[0] = static_cast<signed char>(x < 0.0 ? -1 : 1);
  solution.status = Status::ok;
  solution.uniqueness = Uniqueness::certified;
  solution.solves = 1;
  solution.residual = 0x1p-53;
  solution.bounded = std::fabs(real(p)) + std::fabs(real(m)) <= 0x1p22 * std::fabs(w);
}

/// All ones for the sign -1, else zero.
inline Word mask_of(signed char sign) noexcept { return Word{0} - static_cast<Word>(sign == -1); }

/// A trial for n = 2, in registers.
struct PairTrial {
  Pair x;
  double residual;
  bool clear;     // as clear()
  bool accurate;  // as check()
};

/// Solves W x = b for n = 2 and checks it, with the operations of solve_two(), clear() and check() (that here the sum
/// of both ratios has to be within the limit only sends more to the careful way, and not past NaN).
template <int Capacity>
inline PairTrial try_pair(const Hlcp<Capacity>& problem, Pair sizes, Word negative0, Word negative1) noexcept {
  const PairBits mask = {static_cast<long long>(negative0), static_cast<long long>(negative1)};
  const Pair row0 = choose(gather(problem.plus[0]), gather(problem.minus[0]), mask);
  const Pair row1 = choose(gather(problem.plus[1]), gather(problem.minus[1]), mask);
  const Pair b = gather(problem.b);
  const Pair x = solve_two(row0, row1, sizes, b);
  const Pair along = (Pair)((PairBits)x ^ (mask & sign_bits));
  const Pair size = magnitude(x);
  const double least = along[0] < along[1] ? along[0] : along[1];
  const double largest = size[0] > size[1] ? size[0] : size[1];
  const Pair upper = row0 * x;
  const Pair lower = row1 * x;
  const Pair first = {upper[0], lower[0]};
  const Pair second = {upper[1], lower[1]};
  const Pair scale = (magnitude(first) + magnitude(second)) + magnitude(b);
  const Pair ratio = magnitude((first + second) - b) / scale;
  const double worst = ratio[0] > ratio[1] ? ratio[0] : ratio[1];
  const double lowest = scale[0] < scale[1] ? scale[0] : scale[1];
  return {x, worst, least > tie_window * largest, ratio[0] + ratio[1] <= residual_limit(2) && lowest >= 0x1p-900};
}

/// Whether the four determinants of W(s) have one sign and exceed 2^-19 times the product of the row sizes. False for
/// what is not finite, and where products underflow.
template <int Capacity>
inline bool pair_has_w_property(const Hlcp<Capacity>& problem, Pair sizes) noexcept {
  const Pair p0 = gather(problem.plus[0]);
  const Pair p1 = gather(problem.plus[1]);
  const Pair m0 = gather(problem.minus[0]);
  const Pair m1 = gather(problem.minus[1]);
  const Pair pp = p0 * Pair{p1[1], p1[0]};
  const Pair mm = m0 * Pair{m1[1], m1[0]};
  const Pair pm = Pair{p0[0], m0[1]} * Pair{m1[1], p1[0]};
  const Pair mp = Pair{m0[0], p0[1]} * Pair{p1[1], m1[0]};
  const Pair same = Pair{pp[0], mm[0]} - Pair{pp[1], mm[1]};
  const Pair mixed = Pair{pm[0], mp[0]} - Pair{pm[1], mp[1]};
  const long long flip = ((PairBits)same)[0] & static_cast<long long>(sign_bit);
  const Pair a = (Pair)((PairBits)same ^ PairBits{flip, flip});
  const Pair c = (Pair)((PairBits)mixed ^ PairBits{flip, flip});
  const double low0 = a[0] < c[0] ? a[0] : c[0];
  const double low1 = a[1] < c[1] ? a[1] : c[1];
  const double margin = 0x1p-19 * (sizes[0] * sizes[1]);
  return low0 > margin && low1 > margin && margin >= 0x1p-900;
}

template <int Capacity>
inline void accept_pair(HlcpSolution<Capacity>& solution, Pair x, Word negative0, Word negative1, int solves,
                        double residual) noexcept {
  store(solution.x, x);
  solution.sign[0] = static_cast<signed char>(1 | negative0);
  solution.sign[1] = static_cast<signed char>(1 | negative1);
  solution.status = Status::ok;
  solution.uniqueness = Uniqueness::certified;
  solution.solves = solves;
  solution.residual = residual;
  solution.bounded = true;  // by solve_pair
}

/// n = 2 when the first trial, with this x, was not the solution's: at most three more, while signs change; by the
/// W-property they suffice, ties apart.
template <int Capacity>
[[gnu::noinline]] void solve_pair_again(const Hlcp<Capacity>& problem, Pair x, HlcpSolution<Capacity>& solution,
                                        HlcpOptions options) noexcept {
  if (problem.b[0] == 0.0 && problem.b[1] == 0.0) return accept_pair(solution, Pair{0.0, 0.0}, 0, 0, 1, 0.0);
  Word negative[2] = {mask_of(solution.sign[0]), mask_of(solution.sign[1])};
  for (int solves = 2; solves <= 4; ++solves) {
    const Word next[2] = {Word{0} - (bits(x[0]) >> 63), Word{0} - (bits(x[1]) >> 63)};
    if (next[0] == negative[0] && next[1] == negative[1]) break;
    const PairTrial trial = try_pair(problem, row_sizes(problem), next[0], next[1]);
    if (trial.clear && trial.accurate) return accept_pair(solution, trial.x, next[0], next[1], solves, trial.residual);
    x = trial.x;
    negative[0] = next[0];
    negative[1] = next[1];
  }
  solve_with_care(problem, 2, solution, options, 1);
}

/// n = 2: the W-property by its four determinants, with more room than their rounding errors and the tie window need
/// (the determinant of every matrix between A+ and A- is between them, so |W^-1| R <= 2^20); then one trial if the
/// signs were right.
template <int Capacity>
[[gnu::always_inline]] inline void solve_pair(const Hlcp<Capacity>& problem, HlcpSolution<Capacity>& solution,
                                              HlcpOptions options) noexcept {
  const Word negative0 = mask_of(solution.sign[0]);
  const Word negative1 = mask_of(solution.sign[1]);
  const Pair sizes = row_sizes(problem);
  const PairTrial trial = try_pair(problem, sizes, negative0, negative1);
  const bool usual = pair_has_w_property(problem, sizes);
  if (__builtin_expect(!usual, 0)) return solve_with_care(problem, 2, solution, options, 0);
  if (__builtin_expect(!(trial.clear && trial.accurate), 0))
    return solve_pair_again(problem, trial.x, solution, options);
  accept_pair(solution, trial.x, negative0, negative1, 1, trial.residual);
}

/// Whether x, whose signs are clear, is accurate, or becomes so and keeps them.
template <int Capacity, class Count>
[[gnu::always_inline]] inline bool stands(const Hlcp<Capacity>& problem, Count n, const signed char* signs,
                                          Trial<Capacity>& trial) noexcept {
  check(problem, n, trial);
  if (trial.accurate) return true;
  refine(problem, static_cast<int>(n), trial);
  return trial.accurate && clear(trial.x, n, signs);
}

/// Takes the trial's x if it is certified, or for n > 4 as it is. Requires an accurate x of clear signs.
template <int Capacity, class Count>
[[gnu::always_inline]] inline bool accept_trial(const Hlcp<Capacity>& problem, Count n, const Trial<Capacity>& trial,
                                                const signed char* signs, int solves,
                                                HlcpSolution<Capacity>& solution) noexcept {
  const bool proven = (n <= 16 && trial.reach <= contracting) || proves(problem, n, trial);
  if (!proven && n <= decidable) return false;
  for (int k = 0; k < n; ++k) solution.x[k] = trial.x[k] + 0.0;  // -0 becomes 0
  for (int k = 0; k < n; ++k) solution.sign[k] = static_cast<signed char>(signs[k] == -1 && trial.x[k] != 0.0 ? -1 : 1);
  report(solution, Status::ok, proven ? Uniqueness::certified : Uniqueness::unproven, solves, trial.residual, proven);
  return true;
}

/// n >= 3 when the first trial's signs were not the solution's: the signs that came out are tried next, then those that
/// come out there (iterate_signs() on the problem as given). What that does not settle starts again with care.
template <int Capacity, class Count>
[[gnu::noinline]] void solve_many_again(const Hlcp<Capacity>& problem, Count n, Trial<Capacity>& trial,
                                        HlcpSolution<Capacity>& solution, HlcpOptions options) noexcept {
  signed char signs[Capacity];
  signs_of(code_of(solution.sign, n), n, signs);
  Word seen[Capacity + 4] = {code_of(signs, n)};
  int solves = 1;
  while (solves < n + 4 && solves < options.max_solves) {
    take_signs(trial.x, n, signs);
    const Word code = code_of(signs, n);
    bool repeats = false;
    for (int k = 0; k < solves; ++k) repeats = repeats || seen[k] == code;
    if (repeats) break;
    seen[solves++] = code;
    if (!solve_unchecked(problem, n, signs, trial)) break;
    if (!clear(trial.x, n, signs)) continue;
    if (stands(problem, n, signs, trial) && accept_trial(problem, n, trial, signs, solves, solution)) return;
    break;
  }
  solve_with_care(problem, static_cast<int>(n), solution, options, solves);
}

/// n >= 3: one trial, and nothing more if the signs were right and the certificate holds.
template <int Capacity, class Count>
[[gnu::noinline]] void solve_many(const Hlcp<Capacity>& problem, Count n, HlcpSolution<Capacity>& solution,
                                  HlcpOptions options) noexcept {
  Trial<Capacity> trial;
  if (solve_unchecked(problem, n, solution.sign, trial)) {
    if (!clear(trial.x, n, solution.sign)) return solve_many_again(problem, n, trial, solution, options);
    if (stands(problem, n, solution.sign, trial) && accept_trial(problem, n, trial, solution.sign, 1, solution)) return;
  }
  solve_with_care(problem, static_cast<int>(n), solution, options, 1);
}

/// As solve(), below.
template <int Capacity, class Count>
[[gnu::always_inline]] inline void solve_by_order(const Hlcp<Capacity>& problem, Count n,
                                                  HlcpSolution<Capacity>& solution, HlcpOptions options) noexcept {
  if (n < 0 || n > Capacity) return refuse(solution, Status::invalid_input, 0);
  if (n == 0) return accept(solution, 0, solution.x, Uniqueness::certified, 0, 0.0);
  if (n == 1) return solve_one(problem, solution, options);
  if constexpr (Capacity >= 2)
    if (n == 2) return solve_pair(problem, solution, options);
  if constexpr (Capacity >= 3) solve_many(problem, n, solution, options);
}

}  // namespace hlcp_detail

/// Solves A+ x+ - A- x- = b of order n (WWZ14 (18)), n a std::integral_constant<int, N> or an int.
/// In `solution`: the signs to try first (of the last step, say). Requires max_solves >= 1.
/// ok: x is finite, has its signs, and misses each equation by at most 5 (n + 1) 2^-53 of its terms' magnitudes;
/// `certified` answers do not depend on the signs tried first; `unproven` ones (n > 4) say no more than this, and
/// rounding may hide that there is no solution. Else x and sign are untouched: invalid_input (not
/// finite; n not in 0..Capacity), no_solution, not_unique, singular_constraints (rank lost in working precision),
/// inaccurate (residual, or x out of range), solve_limit.
/// Every problem with n <= 4 is decided as exact arithmetic does, with two exceptions. A rank that rests on less than
/// 2^-49 of a minor's terms: the rounding of the data would decide, so singular_constraints. And, rows and b over their
/// largest entries, an entry below 2^-180 beside which a minor is below 2^-900: underflow would decide, so inaccurate.
/// Cost: with the right signs one LU factorization (n <= 4: cofactors), O(n^2) for the certificate; otherwise up to
/// max_solves of them.
template <int Capacity, class Count>
inline void solve(const Hlcp<Capacity>& problem, Count n, HlcpSolution<Capacity>& solution,
                  HlcpOptions options = {}) noexcept {
  hlcp_detail::solve_by_order(problem, n, solution, options);
  SLIDEWAY_CLAIM(hlcp_detail::within_limit(solution.solves, n, options.max_solves));
  SLIDEWAY_CLAIM(solution.status != Status::ok || hlcp_detail::is_answer(problem, n, solution));
  SLIDEWAY_CLAIM(solution.uniqueness != Uniqueness::certified || hlcp_detail::has_one_sign(problem, n));
}

/// solve_hlcp's answer: x of the order of b, else as HlcpSolution.
template <class Vector, int Capacity>
struct HlcpResult {
  Vector x;
  signed char sign[Capacity];
  Status status;
  Uniqueness uniqueness;
  int solves;
  double residual;
};

/// solve() for Eigen matrices of fixed size, or of dynamic size up to 64 (x is stored in place, nothing allocates).
/// Matrices, maps and blocks of them: only their elements are read, no Eigen arithmetic is used. `signs`: n numbers, -1
/// or +1. invalid_input if the dimensions do not agree or n > 64; x is zero unless ok. Stack: 280 KB, or about 70
/// bytes times the square of the most rows that the types of fixed or bounded size (Eigen's MaxRows) allow.
template <class Plus, class Minus, class Right>
auto solve_hlcp(const Eigen::MatrixBase<Plus>& a_plus, const Eigen::MatrixBase<Minus>& a_minus,
                const Eigen::MatrixBase<Right>& b, const signed char* signs = nullptr,
                HlcpOptions options = {}) noexcept {
  constexpr int rows = Right::RowsAtCompileTime;
  constexpr int most = Right::MaxRowsAtCompileTime;
  constexpr int capacity = most < 1 || most > hlcp_max_order ? hlcp_max_order : most;
  static_assert(Right::ColsAtCompileTime == 1, "b is a column");
  static_assert(rows <= hlcp_max_order, "n <= 64");
  HlcpResult<Eigen::Matrix<double, rows, 1, 0, rows >= 0 ? rows : capacity, 1>, capacity> result;
  const auto n = b.rows();
  const bool agree =
      n >= 0 && n <= capacity && a_plus.rows() == n && a_plus.cols() == n && a_minus.rows() == n && a_minus.cols() == n;
  const int order = agree ? static_cast<int>(n) : 0;
  Hlcp<capacity> problem = {};
  HlcpSolution<capacity> solution = {};
  for (int i = 0; i < order; ++i) {
    for (int j = 0; j < order; ++j) {
      problem.plus[i][j] = a_plus.derived().coeff(i, j);
      problem.minus[i][j] = a_minus.derived().coeff(i, j);
    }
    problem.b[i] = b.derived().coeff(i);
    solution.sign[i] = static_cast<signed char>(signs != nullptr && signs[i] == -1 ? -1 : 1);
  }
  if (!agree)
    hlcp_detail::refuse(solution, Status::invalid_input, 0);
  else if constexpr (rows >= 0)
    solve(problem, std::integral_constant<int, rows>{}, solution, options);
  else
    solve(problem, order, solution, options);
  result.x.resize(order);
  for (int k = 0; k < order; ++k) result.x.coeffRef(k) = solution.status == Status::ok ? solution.x[k] : 0.0;
  std::memcpy(result.sign, solution.sign, sizeof result.sign);
  result.status = solution.status;
  result.uniqueness = solution.uniqueness;
  result.solves = solution.solves;
  result.residual = solution.residual;
  return result;
}

}  // namespace slideway
