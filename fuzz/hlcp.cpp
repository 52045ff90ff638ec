// HLCPs of every kind and of any doubles: the kernel's answers against all exact ones.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "support/fail.hpp"
#include "support/hlcp.hpp"

const char* const slideway::fuzz::target = "hlcp";

namespace {

using namespace slideway;
using namespace slideway::properties;

/// Any doubles, those most often that are handled apart.
double any_entry(Choices& choices) {
  constexpr double limits[] = {0,
                               -0.0,
                               1,
                               -1,
                               std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::min(),
                               std::numeric_limits<double>::denorm_min(),
                               std::numeric_limits<double>::infinity()};
  switch (choices.below(4)) {
    case 0:
      return choices.dyadic(3);
    case 1:
      return limits[choices.below(8)];
    case 2: {
      const double part = choices.fine_dyadic(15);
      return std::ldexp(part, 8 * choices.integer());
    }
    default:
      return choices.any_double();
  }
}

HlcpCase draw_any(Choices& choices, int most_order) {
  HlcpCase problem{1 + choices.below(most_order), {}};
  for (int i = 0; i < problem.n; ++i) {
    for (int j = 0; j < problem.n; ++j) {
      problem.data.plus[i][j] = any_entry(choices);
      problem.data.minus[i][j] = any_entry(choices);
    }
    problem.data.b[i] = any_entry(choices);
  }
  return problem;
}

bool is_readable(HlcpKind kind) { return kind != HlcpKind::scaled && kind != HlcpKind::nearly; }

/// The largest order drawn, by SLIDEWAY_FUZZ_ORDER or of `usual`.
int draw_most_order(Choices& choices) {
  constexpr int usual[] = {3, 3, 3, 3, 3, 3, 4, 5};  // the exact solutions of order 5 take a hundred times as long
  static const char* const asked = std::getenv("SLIDEWAY_FUZZ_ORDER");
  const int drawn = usual[choices.below(8)];
  return asked ? std::clamp(std::atoi(asked), 1, 5) : drawn;
}

HlcpOptions draw_options(Choices& choices) {
  constexpr int most_solves[] = {4096, 1, 2, 7};
  HlcpOptions options;
  if (choices.flag()) options.not_unique = NotUnique::continue_along_signs;
  options.max_solves = most_solves[choices.below(4)];
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices({data, size});
  const int kind = choices.below(hlcp_kinds + 1);
  const int most_order = draw_most_order(choices);
  const unsigned start = choices.byte();
  const HlcpOptions options = draw_options(choices);
  if (kind == hlcp_kinds) {
    fuzz::hold_hlcp(draw_any(choices, most_order), start, options, fuzz::Numbers::any);
    return 0;
  }
  const auto drawn = static_cast<HlcpKind>(kind);
  const HlcpCase problem = draw_hlcp(choices, drawn, most_order);
  fuzz::hold_hlcp(problem, start, options, is_readable(drawn) ? fuzz::Numbers::readable : fuzz::Numbers::any);
  return 0;
}
