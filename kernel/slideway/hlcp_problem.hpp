// What is asked of slideway::solve for A+ x+ - A- x- = b, and what it answers.
#pragma once

#include <slideway/arithmetic.hpp>
#include <slideway/status.hpp>

namespace slideway {

inline constexpr int hlcp_max_order = 64;

/// A+ x+ - A- x- = b, x+ = max(x, 0), x- = max(-x, 0); the same as S x + S*|x| = b with A+ = S + S*, A- = S - S*. Row
/// by row.
template <int Capacity>
struct Hlcp {
  static_assert(Capacity >= 1 && Capacity <= hlcp_max_order, "1 <= order <= 64");
  alignas(16) double plus[Capacity][Capacity];   ///< A+
  alignas(16) double minus[Capacity][Capacity];  ///< A-
  alignas(16) double b[Capacity];
};

/// In: the signs to try first. Out: the solution with its certificate; x and sign are changed only when status is ok.
template <int Capacity>
struct HlcpSolution {
  double x[Capacity];
  signed char sign[Capacity];  ///< +1 or -1 (anything but -1 counts as +1); of a zero: +1
  Status status;
  Uniqueness uniqueness;
  int solves;       ///< sign patterns examined: linear solves, and determinants when an exact decision was needed
  double residual;  ///< bound on max_i |A+ x+ - A- x- - b|_i / (|W||x| + |b|)_i as computed; at most 4 (n + 1) 2^-53
                    ///< when ok
  bool bounded;     ///< |W^-1| R 1 <= 2^22 is shown, R the sizes of the rows in A+ and A-: of data known to 52 bits x
                    ///< keeps 30
};

/// What to do with a problem that is known to have several solutions.
enum class NotUnique : unsigned char {
  refuse,               ///< status not_unique
  continue_along_signs  ///< take the one with the signs given, else the one found first from there; ok and refuted
};

struct HlcpOptions {
  NotUnique not_unique = NotUnique::refuse;
  int max_solves = 4096;  ///< linear solves of the search for n > 4, which can need about 2^(n+1); n <= 4 is decided
                          ///< whatever it says, by at most 16 determinants and 81 supports
};

}  // namespace slideway
