// Problems A+ x+ - A- x- = b as files: JSON with A_plus, A_minus, b or, for an LCP, M, q; and Siconos' LCP files.
#pragma once

#include <optional>
#include <slideway/hlcp_problem.hpp>
#include <string>

namespace slideway::app {

struct HlcpProblem {
  std::string file, hash;
  bool is_lcp = false;  ///< w - M z = q, entered as A+ = I, A- = M, b = q, so that x = w - z
  int n = 0;
  Hlcp<hlcp_max_order> data = {};
};

/// The problem in `file`, "-" being standard input; nothing when it has a defect, which is then on standard error.
std::optional<HlcpProblem> read_hlcp(const std::string& file);

}  // namespace slideway::app
