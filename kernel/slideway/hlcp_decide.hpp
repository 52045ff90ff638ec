// The exact decision of a problem A+ x+ - A- x- = b of order n <= 4: how many solutions, and which signs they have.
// Rarely needed: only when the tests of hlcp.hpp leave a doubt. Everything is read off the signs of minors of [A+ | A-
// | b], and those are exact.
#pragma once

#include <algorithm>
#include <slideway/hlcp_trial.hpp>

namespace slideway::hlcp_detail {

inline constexpr int decidable = 4;  ///< the largest order that is decided exactly
static_assert(decidable == most_by_cofactors, "what determinants do not prove is decided");

/// A sum of doubles without rounding: parts that do not overlap, in order of increasing size (Shewchuk, Discrete
/// Comput. Geom. 18, 1997, GROW-EXPANSION). The Order! terms of a determinant have at most 2^(Order - 1) parts each.
template <int Order>
struct ExactSum {
  static constexpr int terms = Order == 4 ? 24 : Order == 3 ? 6 : Order;
  double part[terms << (Order - 1)];
  int size = 0;

  void add(double term) noexcept {
    int kept = 0;
    for (int i = 0; i < size; ++i) {
      const double sum = term + part[i];
      const double shadow = sum - term;
      const double error = (term - (sum - shadow)) + (part[i] - shadow);
      if (error != 0.0) part[kept++] = error;
      term = sum;
    }
    if (term != 0.0) part[kept++] = term;
    size = kept;
  }

  /// The largest part: it has the sum's sign, and its size but for 2^-52 of it.
  double leading() const noexcept { return size == 0 ? 0.0 : part[size - 1]; }
};

/// Problem data of order n <= 4, scaled to below 2. Signs are exact where every nonzero magnitude is at least 2^-180:
/// products of four, of at least 2^-720, and their errors, of 2^-928, then do not underflow.
template <int Order>
struct Small {
  double plus[Order][Order];
  double minus[Order][Order];
  double b[Order];
  int n;
  bool within_range;
  bool hidden = false;  ///< the sign of some minor that was asked for is lost in underflow
};

/// What a determinant must exceed for its sign to count where its products may underflow: 192 of them and their errors,
/// each off by 2^-1074 times at most three factors below 2 and a few roundings, make less than 2^-1050.
inline constexpr double visible = 0x1p-900;

template <int Order>
struct Minor {
  double a[Order][Order];
  int m;
};

struct Determinant {
  double value;
  double size;  ///< the sum of the magnitudes of all terms (the permanent of |a|)
};

/// det(a) by expansion along rows over all column subsets; at most 32 products.
/// |value - det| <= 2^-49 size: level i adds at most i roundings, 1 + 2 + 3 + 4 in all, and 2^-49 = 16 units.
template <int Order>
inline Determinant determinant(const Minor<Order>& minor) noexcept {
  Determinant of[1 << Order];  // the first 2^m
  of[0] = {1.0, 1.0};
  for (int set = 1; set < (1 << minor.m); ++set) {
    int row = -1;
    for (int k = 0; k < minor.m; ++k) row += (set >> k) & 1;
    Determinant sum = {0.0, 0.0};
    int after = row;  // columns of the set behind k
    for (int k = 0; k < minor.m; ++k) {
      if (((set >> k) & 1) == 0) continue;
      const double entry = minor.a[row][k];
      const Determinant& rest = of[set ^ (1 << k)];
      sum.value += (after & 1) != 0 ? -(entry * rest.value) : entry * rest.value;
      sum.size += (entry < 0.0 ? -entry : entry) * rest.size;
      --after;
    }
    of[set] = sum;
  }
  return of[(1 << minor.m) - 1];
}

/// det(a) rounded once, so that its sign is exact: all m! terms as sums of 2^(m-1) doubles. At most 192 additions of at
/// most 192 parts.
template <int Order>
inline double exact_determinant(const Minor<Order>& minor) noexcept {
  const int m = minor.m < Order ? minor.m : Order;
  ExactSum<Order> sum;
  int column[Order];
  for (int k = 0; k < Order; ++k) column[k] = k;
  for (int term = 0; term < ExactSum<Order>::terms; ++term) {
    int inversions = 0;
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < i; ++k) inversions += column[k] > column[i] ? 1 : 0;
    double part[1 << (Order - 1)] = {(inversions & 1) != 0 ? -1.0 : 1.0};
    int parts = 1;
    for (int i = 0; i < m; ++i) {
      const double entry = minor.a[i][column[i]];
      for (int k = 0; k < parts && i > 0; ++k) part[parts + k] = product_error(part[k], entry);
      for (int k = 0; k < parts; ++k) part[k] *= entry;
      if (i > 0) parts *= 2;
    }
    for (int k = 0; k < parts; ++k)
      if (part[k] != 0.0) sum.add(part[k]);
    if (!std::next_permutation(column, column + m)) break;
  }
  return sum.leading();
}

struct Sign {
  int sign;
  bool frail;  ///< indistinguishable from zero in working precision, though it is not zero or hidden
};

/// The sign of a minor of p.
template <int Order>
inline Sign sign_of(const Minor<Order>& minor, Small<Order>& p) noexcept {
  const Determinant det = determinant(minor);
  const double doubt = larger(0x1p-49 * det.size, p.within_range ? 0.0 : visible);
  if (det.value > doubt) return {1, false};
  if (det.value < -doubt) return {-1, false};
  if (det.size == 0.0 && p.within_range) return {0, false};
  const double exact = exact_determinant(minor);
  if (!p.within_range && !(std::fabs(exact) > visible)) {
    p.hidden = true;
    return {0, true};
  }
  return {(exact > 0.0) - (exact < 0.0), exact != 0.0};
}

/// Column k of W(signs); k = n is b.
template <int Order>
inline double entry(const Small<Order>& p, int row, int k, const signed char* signs) noexcept {
  return k == p.n ? p.b[row] : (signs[k] < 0 ? p.minus[row][k] : p.plus[row][k]);
}

/// The minor of [W(signs) | b] with the rows and columns given as bit sets of equal size.
template <int Order>
inline Minor<Order> minor_of(const Small<Order>& p, int rows, const int* columns, int m,
                             const signed char* signs) noexcept {
  Minor<Order> minor;
  minor.m = m;
  int i = 0;
  for (int row = 0; row < p.n; ++row) {
    if (((rows >> row) & 1) == 0) continue;
    for (int k = 0; k < m; ++k) minor.a[i][k] = entry(p, row, columns[k], signs);
    ++i;
  }
  return minor;
}

inline int count(int set) noexcept {
  int members = 0;
  for (int k = 0; k < decidable; ++k) members += (set >> k) & 1;
  return members;
}

/// Rows on which the m columns are independent (0 if there are none), and the sign of that minor; the least doubtful
/// choice.
struct Basis {
  int rows;
  Sign det;
};

template <int Order>
inline Basis basis_of(Small<Order>& p, const int* columns, int m, const signed char* signs) noexcept {
  Basis found = {0, {0, false}};
  for (int rows = 0; rows < (1 << p.n); ++rows) {
    if (count(rows) != m) continue;
    const Sign det = sign_of(minor_of(p, rows, columns, m, signs), p);
    if (det.sign != 0 && !det.frail) return {rows, det};
    if (det.sign != 0 || (det.frail && found.rows == 0)) found = {det.sign != 0 ? rows : 0, det};
  }
  return found;
}

/// Whether the columns and one more depend on each other in every row, given that they do in the basis rows.
template <int Order>
inline bool dependent_elsewhere(Small<Order>& p, int basis, const int* columns, int m, const signed char* signs,
                                bool& frail) noexcept {
  for (int row = 0; row < p.n; ++row) {
    if (((basis >> row) & 1) != 0) continue;
    const Sign det = sign_of(minor_of(p, basis | (1 << row), columns, m, signs), p);
    frail = frail || det.frail;
    if (det.sign != 0) return false;
  }
  return true;
}

template <int Order>
struct Vertex {
  bool exists;
  bool frail;       ///< a rank on which the answer rests is doubtful in working precision
  double x[Order];  ///< by Cramer's rule, rounded
};

/// Whether there is a solution with exactly the signs sigma in {-1, 0, 1}^n whose columns are independent: a vertex of
/// the solution set.
template <int Order>
inline Vertex<Order> vertex_at(Small<Order>& p, const signed char* sigma) noexcept {
  Vertex<Order> vertex = {false, false, {}};
  int columns[Order + 1] = {};
  int m = 0;
  for (int k = 0; k < p.n; ++k)
    if (sigma[k] != 0) columns[m++] = k;
  const Basis basis = m == 0 ? Basis{0, {1, false}} : basis_of(p, columns, m, sigma);
  vertex.frail = basis.det.frail;
  if (basis.det.sign == 0) return vertex;
  columns[m] = p.n;
  if (!dependent_elsewhere(p, basis.rows, columns, m + 1, sigma, vertex.frail)) return vertex;
  const double det = m == 0 ? 1.0 : determinant(minor_of(p, basis.rows, columns, m, sigma)).value;
  for (int k = 0; k < m; ++k) {
    const int column = columns[k];
    columns[k] = p.n;
    const Minor<Order> numerator = minor_of(p, basis.rows, columns, m, sigma);
    columns[k] = column;
    if (sign_of(numerator, p).sign * basis.det.sign != sigma[column]) return vertex;
    vertex.x[column] = detail::quotient(determinant(numerator).value, det);
  }
  vertex.exists = true;
  return vertex;
}

/// Whether the columns with signs tau != 0 have a null vector with exactly these signs, and no smaller set of them has
/// one: an extreme ray.
template <int Order>
inline bool ray_at(Small<Order>& p, const signed char* tau, bool& frail) noexcept {
  int columns[Order] = {};
  int m = 0;
  for (int k = 0; k < p.n; ++k)
    if (tau[k] != 0) columns[m++] = k;
  const Basis basis = m == 1 ? Basis{0, {1, false}} : basis_of(p, columns, m - 1, tau);
  if (basis.det.sign == 0 || !dependent_elsewhere(p, basis.rows, columns, m, tau, frail)) return false;
  int direction = 0;
  for (int k = 0; k < m; ++k) {
    int others[Order] = {};
    int size = 0;
    for (int i = 0; i < m; ++i)
      if (i != k) others[size++] = columns[i];
    const int det = m == 1 ? 1 : sign_of(minor_of(p, basis.rows, others, size, tau), p).sign;
    const int component = ((k & 1) != 0 ? -det : det) * tau[columns[k]];
    if (component == 0 || component == -direction) return false;
    direction = component;
  }
  return true;
}

enum class Decision : unsigned char { certified, single, several, none, doubtful, hidden };

/// What is true of a small problem.
template <int Order>
struct Decided {
  Decision decision;
  signed char sigma[Order];  ///< the signs in {-1, 0, 1} of the solution to take
  double x[Order];           ///< that solution, roughly
  bool frail;                ///< the rank of that solution's columns is doubtful in working precision
  int determinants;          ///< patterns examined
};

/// The c-th sign vector: base 2 (+1, -1) or base 3 (+1, -1, 0).
inline void pattern(int code, int n, int base, signed char* signs) noexcept {
  constexpr signed char digit[3] = {1, -1, 0};
  for (int k = 0; k < n; ++k) {
    signs[k] = digit[code % base];
    code /= base;
  }
}

/// Whether all 2^n determinants of W(s) have one strict sign: the column W-property (Sznajder & Gowda 1995), that is,
/// one solution for every b.
template <int Order>
inline bool has_w_property(Small<Order>& p, bool& frail) noexcept {
  int columns[Order];
  for (int k = 0; k < Order; ++k) columns[k] = k;
  int common = 0;
  bool holds = true;
  for (int code = 0; code < (1 << p.n); ++code) {
    signed char signs[Order];
    pattern(code, p.n, 2, signs);
    const Sign det = sign_of(minor_of(p, (1 << p.n) - 1, columns, p.n, signs), p);
    frail = frail || det.frail;
    if (det.sign == 0 || det.sign == -common) holds = false;
    common = det.sign;
  }
  return holds;
}

/// Whether no sign of sigma and tau contradicts the other: some orthant contains both.
inline bool compatible(const signed char* sigma, const signed char* tau, int n) noexcept {
  for (int k = 0; k < n; ++k)
    if (sigma[k] * tau[k] < 0) return false;
  return true;
}

/// Whether a ray starts at the vertex sigma inside an orthant: a continuum of solutions.
template <int Order>
inline bool has_ray(Small<Order>& p, const signed char* sigma, int codes, bool& frail) noexcept {
  for (int code = 0; code < codes; ++code) {
    signed char tau[Order];
    pattern(code, p.n, 3, tau);
    bool zero = true;
    for (int k = 0; k < p.n; ++k) zero = zero && tau[k] == 0;
    if (!zero && compatible(sigma, tau, p.n) && ray_at(p, tau, frail)) return true;
  }
  return false;
}

/// Decides A+ x+ - A- x- = b of order n <= 4 as exact arithmetic would.
/// The solutions with signs in one orthant form a polyhedron without lines; so there are solutions iff there are
/// vertices, and exactly one iff there is one vertex and no ray of its orthants starts there. Among several it takes
/// the one with the signs `preferred`, else `second`, else the first. At most 3^n = 81 supports of at most 2 * 6 minors
/// each.
template <int Order>
inline Decided<Order> decide(Small<Order>& p, const signed char* preferred, const signed char* second) noexcept {
  Decided<Order> result = {Decision::none, {}, {}, false, 1 << p.n};
  bool frail = false;
  const bool unique = has_w_property(p, frail);
  int codes = 1;
  for (int k = 0; k < p.n; ++k) codes *= 3;
  int found = 0;
  int sound = 0;
  int liked = 0;
  for (int code = 0; code < codes && !(unique && found == 1); ++code) {
    signed char sigma[Order] = {};
    pattern(code, p.n, 3, sigma);
    const Vertex<Order> vertex = vertex_at(p, sigma);
    frail = frail || (vertex.frail && !vertex.exists);
    if (!vertex.exists) continue;
    const int likes = compatible(sigma, preferred, p.n) ? 2 : (compatible(sigma, second, p.n) ? 1 : 0);
    if (found == 0 || likes > liked) {
      for (int k = 0; k < Order; ++k) {  // of constant length, so that no library function is called
        result.sigma[k] = sigma[k];
        result.x[k] = vertex.x[k];
      }
      result.frail = vertex.frail;
      liked = likes;
    }
    ++found;
    sound += vertex.frail ? 0 : 1;
  }
  if (found == 0) {
    result.decision = frail ? Decision::doubtful : Decision::none;
  } else if (unique) {
    result.decision = Decision::certified;
  } else if (found > 1 || has_ray(p, result.sigma, codes, frail)) {
    result.decision = sound >= 1 && (sound >= 2 || found == 1) ? Decision::several : Decision::doubtful;
  } else {
    result.decision = Decision::single;
  }
  if (p.hidden && result.decision != Decision::certified) result.decision = Decision::hidden;
  return result;
}

}  // namespace slideway::hlcp_detail
