// Problems A+ x+ - A- x- = b that solvers are measured on, each with one solution.
#pragma once

#include <slideway/properties/hlcp.hpp>
#include <string>
#include <vector>

namespace slideway::charts {

using properties::HlcpCase;

/// Problems of one kind, of any of the orders.
struct HlcpFamily {
  std::string name;
  std::string what;  ///< for the reader of the numbers
  bool is_lcp;       ///< A+ = I: w - M z = q as it stands
  std::vector<HlcpCase> (*cases)(int n, int count);
};

inline constexpr int hlcp_orders[] = {2, 4, 8, 16, 32};

/// What mechanisms give, and what resembles it: the W-property holds with room.
const std::vector<HlcpFamily>& kind_families();
/// LCPs from the literature that take pivoting methods exponentially many steps, or make sign iteration cycle. Their
/// matrices are P-matrices.
const std::vector<HlcpFamily>& hard_families();

}  // namespace slideway::charts
