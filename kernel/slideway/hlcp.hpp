// The horizontal linear complementarity problem A+ x+ - A- x- = b, solved and certified. Usable on its own.
//
// For a sign vector s the matrix W(s) has column j of A+ where s_j > 0 and of A- where s_j < 0; x solves the problem
// iff W(s) x = b and s_j x_j >= 0 for some s. One trial is one linear solve with W(s), and everything that follows from
// it: signs, residual, uniqueness. The answer always is the trial of the final signs, so how they were found changes no
// bit of it.
#pragma once

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

/// The residual for n = 2, as check() computes it. False if too large, or if a row's terms are so small that its
/// residual could be lost.
inline bool residual_two(const double (&w)[2][2], const double* b, const double* x, double& residual) noexcept {
  const double term[2][2] = {{w[0][0] * x[0], w[0][1] * x[1]}, {w[1][0] * x[0], w[1][1] * x[1]}};
  const double scale0 = (std::fabs(term[0][0]) + std::fabs(term[0][1])) + std::fabs(b[0]);
  const double scale1 = (std::fabs(term[1][0]) + std::fabs(term[1][1])) + std::fabs(b[1]);
  const double ratio0 = std::fabs((term[0][0] + term[0][1]) - b[0]) / scale0;
  const double ratio1 = std::fabs((term[1][0] + term[1][1]) - b[1]) / scale1;
  residual = ratio0 > ratio1 ? ratio0 : ratio1;
  const double limit = residual_limit(2);
  return (scale0 >= 0x1p-900) & (scale1 >= 0x1p-900) & (ratio0 <= limit) & (ratio1 <= limit);
}

/// n = 1: a quotient. The W-property is that A+ and A- have one sign, and then b decides the sign of x.
template <int Capacity>
inline void solve_one(const Hlcp<Capacity>& problem, HlcpSolution<Capacity>& solution, HlcpOptions options) noexcept {
  const double p = problem.plus[0][0];
  const double m = problem.minus[0][0];
  const double b = problem.b[0];
  const bool usual = sizable(std::fabs(p)) & sizable(std::fabs(m)) & (sizable(std::fabs(b)) | (b == 0.0)) &
                     (((bits(p) ^ bits(m)) >> 63) == 0);
  if (__builtin_expect(!usual, 0)) return solve_with_care(problem, 1, solution, options, 0);
  const bool positive = ((bits(p) ^ bits(b)) >> 63) == 0;
  const double x = b / either(positive, p, m) + 0.0;
  solution.x[0] = x;
  solution.sign[0] = static_cast<signed char>(x < 0.0 ? -1 : 1);
  solution.status = Status::ok;
  solution.uniqueness = Uniqueness::certified;
  solution.solves = 1;
  solution.residual = 0x1p-53;  // the quotient is correctly rounded
}

/// n = 2: the W-property by its four determinants, with more room than their rounding errors and the tie window need,
/// then at most four trials.
template <int Capacity>
inline void solve_pair(const Hlcp<Capacity>& problem, HlcpSolution<Capacity>& solution, HlcpOptions options) noexcept {
  const auto& p = problem.plus;
  const auto& m = problem.minus;
  const double size0 = row_size(problem, 0);
  const double size1 = row_size(problem, 1);
  const double det[4] = {p[0][0] * p[1][1] - p[1][0] * p[0][1], m[0][0] * p[1][1] - m[1][0] * p[0][1],
                         p[0][0] * m[1][1] - p[1][0] * m[0][1], m[0][0] * m[1][1] - m[1][0] * m[0][1]};
  const double low0 = det[0] < det[1] ? det[0] : det[1];
  const double low1 = det[2] < det[3] ? det[2] : det[3];
  const double high0 = det[0] > det[1] ? det[0] : det[1];
  const double high1 = det[2] > det[3] ? det[2] : det[3];
  const double margin = 0x1p-19 * (size0 * size1);
  const bool one_sign = ((low0 < low1 ? low0 : low1) > margin) | ((high0 > high1 ? high0 : high1) < -margin);
  const bool usual = one_sign & sizable(size0) & sizable(size1) & bounded(problem.b[0]) & bounded(problem.b[1]);
  bool negative[2] = {solution.sign[0] == -1, solution.sign[1] == -1};
  for (int solves = 1; usual && solves <= 4; ++solves) {
    const double w[2][2] = {{either(negative[0], m[0][0], p[0][0]), either(negative[1], m[0][1], p[0][1])},
                            {either(negative[0], m[1][0], p[1][0]), either(negative[1], m[1][1], p[1][1])}};
    const double chosen = w[0][0] * w[1][1] - w[1][0] * w[0][1];
    const Two x = solve_two(w, size0, size1, chosen, problem.b[0], problem.b[1]);
    const signed char signs[2] = {static_cast<signed char>(negative[0] ? -1 : 1),
                                  static_cast<signed char>(negative[1] ? -1 : 1)};
    const double both[2] = {x.x0, x.x1};
    if (clear(both, std::integral_constant<int, 2>{}, signs)) {
      double residual = 0.0;
      if (!residual_two(w, problem.b, both, residual)) break;
      return accept(solution, std::integral_constant<int, 2>{}, both, Uniqueness::certified, solves, residual);
    }
    negative[0] = x.x0 < 0.0;
    negative[1] = x.x1 < 0.0;
  }
  solve_with_care(problem, 2, solution, options, usual ? 1 : 0);
}

/// n >= 3: one trial, and nothing more if the signs were right and the certificate holds.
template <int Capacity, class Count>
[[gnu::noinline]] void solve_many(const Hlcp<Capacity>& problem, Count n, HlcpSolution<Capacity>& solution,
                                  HlcpOptions options) noexcept {
  Trial<Capacity> trial;
  if (attempt(problem, n, solution.sign, trial) && clear(trial.x, n, solution.sign)) {
    const bool proven = (n <= 16 && trial.reach <= contracting) || proves(problem, static_cast<int>(n), trial);
    if (proven || n > decidable)
      return accept(solution, n, trial.x, proven ? Uniqueness::certified : Uniqueness::unproven, 1, trial.residual);
  }
  solve_with_care(problem, static_cast<int>(n), solution, options, 1);
}

}  // namespace hlcp_detail

/// Solves A+ x+ - A- x- = b of order n (WWZ14 (18)), n a std::integral_constant<int, N> or an int.
/// In `solution`: the signs to try first (of the last step, say). Requires max_solves >= 1.
/// ok: x is finite, has its signs, and misses each equation by at most 5 (n + 1) 2^-53 of its terms' magnitudes;
/// `certified` answers do not depend on the signs tried first. Else x and sign are untouched: invalid_input (not
/// finite; n not in 0..Capacity), no_solution, not_unique, singular_constraints (rank lost in working precision),
/// inaccurate (residual, or x out of range), solve_limit. Every problem with n <= 4 is decided. Cost: with the right
/// signs one LU factorization, O(n^2) for the certificate; otherwise up to max_solves of them.
template <int Capacity, class Count>
inline void solve(const Hlcp<Capacity>& problem, Count n, HlcpSolution<Capacity>& solution,
                  HlcpOptions options = {}) noexcept {
  if (n < 0 || n > Capacity) return hlcp_detail::refuse(solution, Status::invalid_input, 0);
  if (n == 0) return hlcp_detail::accept(solution, 0, solution.x, Uniqueness::certified, 0, 0.0);
  if (n == 1) return hlcp_detail::solve_one(problem, solution, options);
  if constexpr (Capacity >= 2)
    if (n == 2) return hlcp_detail::solve_pair(problem, solution, options);
  if constexpr (Capacity >= 3) hlcp_detail::solve_many(problem, n, solution, options);
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

/// solve() for Eigen matrices of fixed size, or of dynamic size up to 32 (x is stored in place, nothing allocates).
/// Matrices, maps and blocks of them: only their elements are read, no Eigen arithmetic is used. `signs`: n numbers, -1
/// or +1. invalid_input if the dimensions do not agree or n > 32; x is zero unless ok.
template <class Plus, class Minus, class Right>
auto solve_hlcp(const Eigen::MatrixBase<Plus>& a_plus, const Eigen::MatrixBase<Minus>& a_minus,
                const Eigen::MatrixBase<Right>& b, const signed char* signs = nullptr,
                HlcpOptions options = {}) noexcept {
  constexpr int rows = Right::RowsAtCompileTime;
  constexpr int most = Right::MaxRowsAtCompileTime;
  constexpr int capacity = most < 1 || most > hlcp_max_order ? hlcp_max_order : most;
  static_assert(Right::ColsAtCompileTime == 1, "b is a column");
  static_assert(rows <= hlcp_max_order, "n <= 32");
  HlcpResult<Eigen::Matrix<double, rows, 1, 0, rows >= 0 ? rows : capacity, 1>, capacity> result;
  const auto n = b.rows();
  const bool agree =
      n >= 0 && n <= capacity && a_plus.rows() == n && a_plus.cols() == n && a_minus.rows() == n && a_minus.cols() == n;
  const int order = agree ? static_cast<int>(n) : 0;
  Hlcp<capacity> problem;
  HlcpSolution<capacity> solution = {};
  for (int i = 0; i < order; ++i) {
    for (int j = 0; j < order; ++j) {
      problem.plus[i][j] = a_plus.derived().coeff(i, j);
      problem.minus[i][j] = a_minus.derived().coeff(i, j);
    }
    problem.b[i] = b.derived().coeff(i);
    solution.sign[i] = static_cast<signed char>(signs != nullptr && signs[i] == -1 ? -1 : 1);
  }
  if constexpr (rows >= 0)
    solve(problem, std::integral_constant<int, rows>{}, solution, options);
  else
    solve(problem, order, solution, options);
  if (!agree) hlcp_detail::refuse(solution, Status::invalid_input, 0);
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
