// Orders 2 to 4 by determinants.
#pragma once

#include <slideway/arithmetic.hpp>
#include <slideway/hlcp_pairs.hpp>
#include <slideway/hlcp_problem.hpp>

namespace slideway::hlcp_detail {

/// What the two-by-two formula needs beside W: the row sizes |a+_i0| + |a+_i1| + |a-_i0| + |a-_i1|.
template <int Capacity>
inline Pair row_sizes(const Hlcp<Capacity>& problem) noexcept {
  const Pair upper = magnitude(gather(problem.plus[0])) + magnitude(gather(problem.minus[0]));
  const Pair lower = magnitude(gather(problem.plus[1])) + magnitude(gather(problem.minus[1]));
  return Pair{upper[0], lower[0]} + Pair{upper[1], lower[1]};
}

/// (row0, row1) x = b for n = 2: x1 by Cramer's rule, x0 from the row with the larger weighted entry. As stable as
/// elimination with that pivot (numerator and determinant are its Schur complements times the pivot), with one division
/// less in the chain.
inline Pair solve_two(Pair row0, Pair row1, Pair size, Pair b) noexcept {
  const Pair pivot = {row0[0], row1[0]};
  const Pair schur = Pair{pivot[0], pivot[0]} * Pair{b[1], row1[1]} - Pair{pivot[1], pivot[1]} * Pair{b[0], row0[1]};
  const double x1 = detail::quotient(schur[0], schur[1]);
  const Pair weight = magnitude(pivot) * Pair{size[1], size[0]};
  const bool first = bits(weight[0]) >= bits(weight[1]);
  const double rest = either(first, b[0], b[1]) - either(first, row0[1], row1[1]) * x1;
  return Pair{detail::quotient(rest, either(first, pivot[0], pivot[1])), x1};
}

/// A column of order 4 in rows 0 | 2 and rows 1 | 3. Order 3 goes with a fourth row and column of the unit matrix.
struct Column {
  Pair even;
  Pair odd;
};

/// Column k of a matrix of order n = 3 or 4, row by row in `w`.
template <int Rows, int Stride, class Count>
[[gnu::always_inline]] inline Column column_of(const double (&w)[Rows][Stride], Count n, int k) noexcept {
  constexpr int last = Rows > 3 ? 3 : 2;
  if (n == 3 && k == 3) return {Pair{0.0, 0.0}, Pair{0.0, 1.0}};
  return {Pair{w[0][k], w[2][k]}, Pair{w[1][k], n == 3 ? 0.0 : w[last][k]}};
}

/// The minors of columns a and b in rows 0, 1 | rows 2, 3.
inline Pair minors_of(Column a, Column b) noexcept { return a.even * b.odd - a.odd * b.even; }

inline Pair swapped(Pair pair) noexcept { return Pair{pair[1], pair[0]}; }

/// adj(W) in rows, each as a Column, and det W: W^-1 = adj(W) / det W.
struct Adjugate {
  Column row[4];
  double determinant;
};

/// By Laplace expansion along rows 0, 1 and rows 2, 3. An entry is off by at most 5, the determinant by 8 times 2^-53
/// times the product of sum_j |w_ij| over the rows i that it is made of.
template <int Rows, int Stride, class Count>
[[gnu::always_inline]] inline Adjugate adjugate_of(const double (&w)[Rows][Stride], Count n) noexcept {
  const Column c0 = column_of(w, n, 0);
  const Column c1 = column_of(w, n, 1);
  const Column c2 = column_of(w, n, 2);
  const Column c3 = column_of(w, n, 3);
  const Pair m01 = minors_of(c0, c1);
  const Pair m02 = minors_of(c0, c2);
  const Pair m03 = minors_of(c0, c3);
  const Pair t01 = swapped(m01);
  const Pair t02 = swapped(m02);
  const Pair t03 = swapped(m03);
  const Pair t12 = swapped(minors_of(c1, c2));
  const Pair t13 = swapped(minors_of(c1, c3));
  const Pair t23 = swapped(minors_of(c2, c3));
  const Pair halves = (m01 * t23 - m02 * t13) + m03 * t12;
  return {{{(c1.odd * t23 - c2.odd * t13) + c3.odd * t12, (c2.even * t13 - c1.even * t23) - c3.even * t12},
           {(c2.odd * t03 - c0.odd * t23) - c3.odd * t02, (c0.even * t23 - c2.even * t03) + c3.even * t02},
           {(c0.odd * t13 - c1.odd * t03) + c3.odd * t01, (c1.even * t03 - c0.even * t13) - c3.even * t01},
           {(c1.odd * t02 - c0.odd * t12) - c2.odd * t01, (c0.even * t12 - c1.even * t02) + c2.even * t01}},
          halves[0] + halves[1]};
}

inline Column magnitude(Column column) noexcept { return {magnitude(column.even), magnitude(column.odd)}; }

inline double largest_of(Column column) noexcept {
  return larger(larger(column.even[0], column.even[1]), larger(column.odd[0], column.odd[1]));
}

/// The products of two rows with a column.
[[gnu::always_inline]] inline Pair products(Column first, Column second, Column v) noexcept {
  return sums(first.even * v.even + first.odd * v.odd, second.even * v.even + second.odd * v.odd);
}

/// Of all 2^n determinants of W(s), n = 3 or 4, the least where the first is positive, the least of -det W(s) where it
/// is negative. Laplace expansion as above: every 2x2 minor is shared by four patterns.
template <int Capacity, class Count>
inline double least_determinant(const Hlcp<Capacity>& problem, Count n) noexcept {
  static_assert(Capacity >= 3, "rows and columns exist");
  Column column[4][2];
  for (int k = 0; k < 4; ++k) {
    column[k][0] = column_of(problem.plus, n, k);
    column[k][1] = column_of(problem.minus, n, k);
  }
  Pair with_last[3][2][2];  // of columns k and 3, swapped
  Pair without[3][2][2];    // of the other two
  for (int k = 0; k < 3; ++k)
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        with_last[k][a][b] = swapped(minors_of(column[k][a], column[3][b]));
        without[k][a][b] = minors_of(column[(k + 1) % 3][a], column[(k + 2) % 3][b]);
      }
  Pair all[8];
  for (int code = 0; code < 8; ++code) {
    const int s[3] = {code & 1, (code >> 1) & 1, code >> 2};
    const auto halves = [&](int last) __attribute__((always_inline)) {
      return (without[0][s[1]][s[2]] * with_last[0][s[0]][last] + without[1][s[2]][s[0]] * with_last[1][s[1]][last]) +
             without[2][s[0]][s[1]] * with_last[2][s[2]][last];
    };
    all[code] = sums(halves(0), halves(1));
  }
  const long long flip = ((PairBits)all[0])[0] & static_cast<long long>(sign_bit);
  double least = HUGE_VAL;
  for (const Pair pair : all) {
    const Pair along = (Pair)((PairBits)pair ^ PairBits{flip, flip});
    const double lower = along[0] < along[1] ? along[0] : along[1];
    least = lower < least ? lower : least;
  }
  return least;
}

}  // namespace slideway::hlcp_detail
