// Problems as `slideway hlcp` reads them, JSON or Siconos' text: a problem or one line about what is wrong with it. A
// problem reads back from its own JSON, and its answer is held as in hlcp.cpp.
#include <algorithm>
#include <hlcp_problem.hpp>

#include "support/fail.hpp"
#include "support/hlcp.hpp"

const char* const slideway::fuzz::target = "command";

namespace {

using namespace slideway;
using namespace slideway::fuzz;

app::HlcpReading read(const std::string& text, const std::string& file) {
  app::HlcpReading reading = app::parse_hlcp(text, file);
  const std::string& line = reading.defect;
  if (reading.problem.has_value() != line.empty()) fail("a problem with a defect, or neither");
  const bool printable = std::all_of(line.begin(), line.end(), [](char c) { return c < 0 || (c >= ' ' && c != 127); });
  if (!line.empty() && (!line.starts_with(file + ":") || !printable)) fail("a defect is not a line: " + line);
  return reading;
}

bool same(const properties::HlcpCase& a, const properties::HlcpCase& b) {
  bool all = a.n == b.n;
  for (int i = 0; i < a.n && all; ++i) {
    for (int j = 0; j < a.n; ++j)
      all = all && a.data.plus[i][j] == b.data.plus[i][j] && a.data.minus[i][j] == b.data.minus[i][j];
    all = all && a.data.b[i] == b.data.b[i];
  }
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const app::HlcpReading reading = read(text, "fuzz.json");
  read(text, "fuzz.dat");
  if (!reading.problem) return 0;
  const properties::HlcpCase& problem = *reading.problem;
  const app::HlcpReading again = read(properties::json(problem), "again.json");
  if (!again.problem || !same(*again.problem, problem))
    fail("its own text reads as another: " + properties::json(problem));
  HlcpOptions options;
  options.max_solves = 256;
  hold_hlcp(problem, 0, options, Numbers::any);
  return 0;
}
