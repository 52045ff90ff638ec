#include "verification.hpp"

#include <algorithm>
#include <cmath>

namespace slideway::app {

double Check::shared(double x) const {
  constexpr double of_a_double = 53 * 0.30102999566398120;
  if (x != x) return 0;
  return x > 0 ? std::clamp(-std::log10(x / scale), 0.0, of_a_double) : of_a_double;
}

bool Verification::held() const {
  return run.recording.status == Status::ok && reference_end.empty() &&
         std::all_of(groups.begin(), groups.end(), [](const CheckGroup& group) {
           return std::all_of(group.checks.begin(), group.checks.end(), [](const Check& c) { return c.held(); });
         });
}

void ask_for_digits(Verification& verification, double digits) {
  for (CheckGroup& group : verification.groups) {
    for (Check& check : group.checks) {
      if (check.counts()) continue;
      check.bound = check.scale * std::pow(10.0, -digits);
      for (const double error : check.curve) check.error = error > check.error ? error : check.error;
    }
  }
}

}  // namespace slideway::app
