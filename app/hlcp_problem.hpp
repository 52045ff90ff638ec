// Problems A+ x+ - A- x- = b as files: JSON with A_plus, A_minus, b or, for an LCP, M, q; and Siconos' LCP files.
#pragma once

#include <optional>
#include <slideway/properties/hlcp.hpp>
#include <string>

namespace slideway::app {

struct HlcpProblem : properties::HlcpCase {
  std::string file, hash;
  bool is_lcp = false;  ///< w - M z = q, entered as A+ = I, A- = M, b = q, so that x = w - z
};

/// A problem, or the line that says why a text is none.
struct HlcpReading {
  std::optional<HlcpProblem> problem;
  std::string defect;
};

/// The problem that a file of this name and text holds.
HlcpReading parse_hlcp(const std::string& text, const std::string& file);

/// The problem in `file`, "-" being standard input; nothing when it has a defect, which is then on standard error.
std::optional<HlcpProblem> read_hlcp(const std::string& file);

}  // namespace slideway::app
