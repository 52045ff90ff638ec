// Every solution of the horizontal linear complementarity problem A+ x+ - A- x- = b, in exact arithmetic: no tolerance,
// no iteration, nothing of the kernel's.
//
// For a sign vector s let W(s) have column j of A+ where s_j = 1 and of A- where s_j = -1. The solutions are the union
// over s of the polyhedra P(s) = {x : W(s) x = b, s_j x_j >= 0}. Each lies in one orthant, so it contains no line: it
// is not empty iff it has a vertex, and it is more than one point iff it has a second vertex or an extreme ray. A
// vertex has linearly independent columns of W(s) as its support; an extreme ray is a solution of W(s) z = 0, s_j z_j
// >= 0 of least support. Both are found from their supports alone, each once. Hence
//
//   * there is a solution iff there is a vertex;
//   * a vertex lies on a continuum of solutions iff another vertex or a ray has no sign opposite to it, for then, and
//     only then, both are in one P(s); all other vertices are isolated solutions, and there are no others;
//   * if all 2^n determinants of W(s) are different from zero, each P(s) is one point or empty, and if they have one
//     sign the column W-property holds: one solution for every b (Sznajder & Gowda 1995).
//
// Cost: 2^n determinants if none is zero, else up to 3^n supports; those that start alike share their elimination.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <type_traits>
#include <vector>

namespace slideway::oracle {

using Rational = boost::multiprecision::cpp_rational;
using Exact = std::vector<Rational>;  ///< a vector, exactly

/// Minors of order 4 of doubles of about one size need no heap.
using Integer =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>, boost::multiprecision::et_off>;

inline constexpr int exact_max_order = 12;  ///< of doubles: 4096 patterns in 0.1 s, 531441 supports in 5 s

/// [A+ | A- | b] row by row, each row times a positive number of its own that makes it integer: solutions and signs of
/// determinants stay what they are.
struct ExactHlcp {
  int n = 0;
  std::vector<Integer> rows;  ///< n times (2 n + 1)
};

/// Appends a row of 2 n + 1 numbers. invalid_argument if one is not finite.
void append_row(ExactHlcp& problem, const std::vector<double>& row);
void append_row(ExactHlcp& problem, const Exact& row);

/// The problem of order n with the matrices plus[i][j], minus[i][j] and b[i], of doubles or of anything that converts
/// exactly to Rational (integers, cpp_bin_float, mpfr_float).
template <class Matrix, class Vector>
ExactHlcp exact_hlcp(int n, const Matrix& plus, const Matrix& minus, const Vector& b) {
  using Given = std::decay_t<decltype(b[0])>;
  using Number = std::conditional_t<std::is_same_v<Given, double>, double, Rational>;
  ExactHlcp problem{n, {}};
  problem.rows.reserve(static_cast<std::size_t>(n) * (2 * static_cast<std::size_t>(n) + 1));
  std::vector<Number> row;
  row.reserve(2 * static_cast<std::size_t>(n) + 1);
  for (int i = 0; i < n; ++i) {
    row.clear();
    for (int j = 0; j < n; ++j) row.push_back(Number(plus[i][j]));
    for (int j = 0; j < n; ++j) row.push_back(Number(minus[i][j]));
    row.push_back(Number(b[i]));
    append_row(problem, row);
  }
  return problem;
}

/// w - M z = q, w, z >= 0, w'z = 0 with x = w - z: A+ = I, A- = M, b = q.
template <class Matrix, class Vector>
ExactHlcp exact_lcp(int n, const Matrix& m, const Vector& q) {
  std::vector<std::vector<std::decay_t<decltype(q[0])>>> one(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < one.size(); ++i) {
    one[i].resize(one.size());
    one[i][i] = 1;
  }
  return exact_hlcp(n, one, m, q);
}

enum class Count { none, one, several, continuum };

struct ExactAnswer {
  bool w_property = false;
  std::vector<Exact> isolated;   ///< every solution that has no other near it
  std::vector<Exact> continuum;  ///< the vertices of all continua: not empty iff there are infinitely many solutions

  Count count() const;
};

enum class Want {
  solutions,
  counts  ///< of the solutions no more than how many: they are empty vectors. Their fractions cost more than all else
};

/// All solutions. invalid_argument if n > exact_max_order.
ExactAnswer solve(const ExactHlcp& problem, Want want = Want::solutions);

/// Whether all det W(s) have one strict sign; stops at the first that has not. Requires n <= exact_max_order.
bool has_w_property(const ExactHlcp& problem);

/// max_i |A+ x+ - A- x- - b|_i / (|A+| x+ + |A-| x- + |b|)_i, a row of zeros counting 0: zero iff x is a solution. Of
/// any order.
Rational residual(const ExactHlcp& problem, const Exact& x);
/// The same of doubles, rounded as by nearest_double(), and faster.
double residual(const ExactHlcp& problem, const double* x);

/// max |x - y| / max |y|; max |x| where y = 0.
Rational distance(const Exact& x, const Exact& y);

/// Exactly the doubles.
Exact exact_vector(const double* x, int n);

/// The double nearest to it, ties to even (below 2^-1022, where it is rounded twice, one of the two nearest).
double nearest_double(const Rational& value);

}  // namespace slideway::oracle
