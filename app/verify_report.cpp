#include "verify_report.hpp"

#include "page.hpp"
#include "verify_table.hpp"

namespace slideway::app {
namespace {

/// Errors are drawn, over twenty decades: four digits are more than a screen shows.
io::Json errors(const std::vector<double>& curve) {
  io::Json result = io::Json::array();
  for (double error : curve) result.push_back(rounded(error, 4));
  return result;
}

/// The errors over the run: the last group has them at the run's samples, up to where the oracle's trajectory ends.
/// Curves are by quantity, an empty one for a quantity that has none.
io::Json curves(const Verification& verification) {
  io::Json times = io::Json::array(), all = io::Json::array();
  for (const Sample& sample : verification.run.samples) times.push_back(rounded(sample.t, 9));
  if (!verification.groups.empty()) {
    for (const Check& check : verification.groups.back().checks) all.push_back(errors(check.curve));
  }
  return {{"t", times}, {"errors", all}};
}

}  // namespace

void write_verify_report(const Verification& verification, std::ostream& out) {
  const Recording& run = verification.run.recording;
  write_page("verify.html", run.file.name,
             {{"document", verify_document(verification)},
              {"duration", rounded(run.duration, 9)},
              {"curves", curves(verification)}},
             out);
}

}  // namespace slideway::app
