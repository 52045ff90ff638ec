// The kernel's HLCP solver and others on the same problems: who is right, and in what time.
#pragma once

#include <functional>

#include "families.hpp"

namespace slideway::charts {

/// What came of a solver's answers to the problems of a family.
struct Verdicts {
  int right = 0;
  int refused = 0;  ///< it says that it has no answer
  int wrong = 0;    ///< it says success, and the answer is none
};

enum class Conversion { none, of_theirs };  ///< of the HLCP to an LCP, in their time or not

/// One solver on the problems of one family and order.
struct HlcpMeasured {
  std::string family;
  int n;
  std::string solver;
  bool warm;              ///< it starts from the right signs; of others, from z that is off by 1e-3
  Conversion conversion;  ///< none for the kernel, and where the problem is an LCP
  Verdicts verdicts;
  int certified = 0;                       ///< answers that the kernel proves to be the only ones
  double solves = 0;                       ///< sign patterns that the kernel examined, on average
  double ns = 0, ns_low = 0, ns_high = 0;  ///< for each solve; 0 where not every answer was right
};

inline constexpr char kernel_solver[] = "slideway";

struct HlcpEffort {
  int cases = 16;
  int repetitions = 15;
  double least = 0.002;  ///< s, of a repetition
  int most_exact = 8;    ///< order up to which answers are held against the exact one
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// All solvers on all families and orders.
std::vector<HlcpMeasured> measure_hlcp(const std::vector<HlcpFamily>& families, const HlcpEffort& effort);

/// An answer is right if no equation is missed by more of its terms than this, and no component of the exact solution
/// by more of the largest: room for all iterations, which stop at 1e-10.
inline constexpr double hlcp_tolerance = 1e-6;

}  // namespace slideway::charts
