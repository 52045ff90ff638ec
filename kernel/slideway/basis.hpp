// Rows in the mass metric, made orthonormal one by one: which of them are independent, and the least change that they
// ask for.
#pragma once

#include <slideway/friction.hpp>

namespace slideway {

/// Gram and Schmidt, twice for each row, which is enough (Giraud and others 2005). `change` is the shortest vector x
/// with row . x = right for all rows taken.
template <class Source, int Capacity>
struct Basis {
  using Size = typename Source::Size;
  static constexpr int n_free = at_least_one(Size::coordinates);

  const Source& source;
  int count = 0;
  double Q[Capacity + 1][n_free];  ///< the last place is for a row that is not taken
  int part_of[Capacity + 1];
  double along[Capacity + 1];
  double change[n_free];

  explicit Basis(const Source& s) noexcept : source(s) { forget(0); }

  /// Where the next row is to be written, by free coordinate of its part.
  double* next() noexcept { return Q[count]; }

  /// Takes that row, of a part, of length `size` before anything was taken from it, with its right side. False, and
  /// nothing done, when it is a combination of those before it to rounding (rank_bound). O(rows n) of its part.
  bool take(int part, double size, double right) noexcept {
    double* row = Q[count];
    for (int twice = 0; twice < 2; ++twice) {
      for (int i = 0; i < count; ++i) {
        if (part_of[i] != part) continue;
        const double shared = inner(source, part, Q[i], row);
        right -= shared * along[i];
        add_scaled(source, part, -shared, Q[i], row);
      }
    }
    const double rest = std::sqrt(inner(source, part, row, row));
    if (!(rest > rank_bound(source) * size) || count == Capacity) return false;
    each_in_part(source, part, [&](int f) SLIDEWAY_FOLD { row[f] *= 1 / rest; });
    part_of[count] = part;
    along[count] = right / rest;
    add_scaled(source, part, along[count], row, change);
    ++count;
    return true;
  }

  /// Back to the first `rows` rows.
  void forget(int rows) noexcept {
    count = rows;
    for (double& x : change) x = 0;
    for (int i = 0; i < count; ++i) add_scaled(source, part_of[i], along[i], Q[i], change);
  }
};

}  // namespace slideway
