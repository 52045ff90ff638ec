// Times of runs that take turns, so that what else the machine does falls on all of them alike; by the processor's time
// of the whole program, threads of theirs included, not by the clock.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace slideway::charts {

struct Run {
  std::string name;  ///< of its own
  std::function<void()> go;
  double parts = 1;  ///< steps, solves: what the time is given for each of
};

/// ns: median, least and most of the repetitions.
struct Timing {
  double ns = 0, low = 0, high = 0;
};

/// Each of `repetitions` takes `seconds` at least.
std::vector<Timing> time_in_turns(const std::vector<Run>& runs, int repetitions, double seconds,
                                  const std::function<void(double, const std::string&)>& progress);

}  // namespace slideway::charts
