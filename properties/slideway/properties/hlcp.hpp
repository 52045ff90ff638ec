// What must hold of every answer to A+ x+ - A- x- = b, the kernel's or another solver's: it is held against all exact
// solutions. And problems of every kind to try.
#pragma once

#include <optional>
#include <slideway/hlcp_problem.hpp>
#include <slideway/oracle/hlcp.hpp>
#include <slideway/properties/choices.hpp>
#include <string>

namespace slideway::properties {

/// A problem of order n <= 64.
struct HlcpCase {
  int n = 0;
  Hlcp<hlcp_max_order> data = {};
};

/// An answer to it, by whichever solver. status ok: x (which alone is looked at, with uniqueness); no_solution and
/// not_unique claim that; any other claims nothing. uniqueness `unproven` claims nothing.
using HlcpAnswer = HlcpSolution<hlcp_max_order>;

/// The kernel's, from the signs tried first that `start` has bits for.
HlcpAnswer kernel_answer(const HlcpCase& problem, unsigned long long start = 0, HlcpOptions options = {});

/// The problem w - M z = q, w, z >= 0, w'z = 0 as an HLCP: A+ = I, A- = M, b = q, x = w - z. `m` row by row.
HlcpCase lcp_case(int n, const double* m, const double* q);
/// An LCP solver's z as an answer: x = w - z, w = q + M z, but zero where z > w or w > z says so: x_k is -z_k if z_k is
/// the larger, w_k else. So x misses the equations by what w'z = 0 is missed by.
HlcpAnswer lcp_answer(const HlcpCase& lcp, const double* z);
/// What says nothing: the solver gave up.
HlcpAnswer no_answer();

/// Largest max_i |A+ x+ - A- x- - b|_i / (|W||x| + |b|)_i of the kernel's x: 4 (n + 1) 2^-53 as it computes it, and as
/// much as n + 1 roundings more in truth.
constexpr double residual_promised(int n) { return 5 * (n + 1) * 0x1p-53; }

enum class Judgement {
  agree,     ///< what is claimed is true
  silent,    ///< nothing is claimed of whether there is a solution
  disagree,  ///< a claim is false
};

struct HlcpCheck {
  HlcpAnswer answer = {};
  std::optional<oracle::ExactAnswer> exact;  ///< none above oracle::exact_max_order
  Judgement judgement = Judgement::disagree;
  std::string verdict;

  // Where there is an x:
  double residual = 0.0;  ///< of x, exactly (rounded once); in the kernel's measure
  int nearest = -1;       ///< isolated solution nearest to x, if there is one
  double distance = 0.0;  ///< from it, relative, in the largest component

  bool solved() const noexcept { return answer.status == Status::ok; }
  bool agree() const noexcept { return judgement == Judgement::agree; }
};

/// Holds an answer against the exact ones. x has to satisfy the equations to `residual` (see residual_promised), there
/// has to be a solution, `single` must be the only one, `certified` by the W-property, `refuted` not the only one. An x
/// that misses no equation beyond that is an exact solution of a problem that differs by as much from this one, entry
/// by entry: that is what doubles can do. Cost: 3^n for the exact solutions, n <= 12. With Want::counts, the exact
/// solutions are counted alone, and there is no nearest one: the judgement is the same, in half the time.
HlcpCheck check_hlcp(const HlcpCase& problem, const HlcpAnswer& answer, double residual,
                     oracle::Want want = oracle::Want::solutions);
inline HlcpCheck check_hlcp(const HlcpCase& problem, const HlcpAnswer& answer) {
  return check_hlcp(problem, answer, residual_promised(problem.n));
}

/// "no solution", "one solution", "3 solutions", "a continuum of solutions".
std::string describe(const oracle::ExactAnswer& answer);

/// The kinds of problems that draw_hlcp() draws from.
enum class HlcpKind {
  small_integers,  ///< entries of {-1, 0, 1}
  dyadic,          ///< entries of a few bits
  lcp,             ///< A+ = I, A- dyadic
  friction,        ///< S + S*|.| with S = N N' + D and weak S*: the W-property holds
  strong,          ///< the same, S* about as large as S: often it does not
  singular,        ///< a row or a column of W(s) follows from others
  degenerate,      ///< the solution has zeros
  scaled,          ///< rows and b by powers of two from 2^-60 to 2^60
  nearly,          ///< degenerate or singular but for a few of the last bits
  textbook,        ///< Murty, Fathi, Kostreva, and what makes sign iteration cycle
};
inline constexpr int hlcp_kinds = 10;
const char* name(HlcpKind kind);

/// A problem of the given kind, 1 <= n <= most_order; the simplest where the choices are used up.
HlcpCase draw_hlcp(Choices& choices, HlcpKind kind, int most_order);

/// The problem with entries of {-1, 0, 1} that `code` numbers in base 3, digit 0 being 0, 1 being 1, 2 being -1: for an
/// LCP M and q, else A+, A- and b; row by row.
HlcpCase small_hlcp(int n, unsigned long long code, bool is_lcp);
unsigned long long small_hlcps(int n, bool is_lcp);  ///< how many of them there are

/// As a file that `slideway hlcp` reads, doubles with all digits.
std::string json(const HlcpCase& problem);

}  // namespace slideway::properties
