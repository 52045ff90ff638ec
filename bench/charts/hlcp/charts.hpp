// Charts and numbers of the HLCP solvers.
#pragma once

#include <slideway/io/json.hpp>

#include "figure.hpp"
#include "measure.hpp"

namespace slideway::charts {

/// A chart of the solvers on some families.
struct HlcpBoard {
  std::string name, title;
  const std::vector<HlcpFamily>& (*families)();
  bool by_family;  ///< a line for each family, of the kernel and of lexicolemke; else for each solver
  std::vector<HlcpMeasured> measured;
};

/// "hlcp_kind" and "hlcp_hard", not yet measured.
std::vector<HlcpBoard> hlcp_boards();

/// Times over orders, of solvers that are right in every problem of an order; of each family, or their geometric means.
Chart hlcp_chart(const HlcpBoard& board);
io::Json document(const HlcpBoard& board);
/// By how much the kernel has to be faster than lexicolemke, and is: a line each.
std::vector<std::string> bars(const HlcpBoard& board);

}  // namespace slideway::charts
