// Times of things that are compared: repetitions in random turns, so that what else the machine does meets all alike,
// and the processor's time, not the clock's.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace slideway::charts {

struct Timed {
  std::string name;  ///< one of a kind
  std::function<void()> run;
  double ns = 0, ns_low = 0, ns_high = 0;  ///< of one run: median, least and most of the repetitions
};

/// Google Benchmark, at least `least` s for each repetition.
void time_interleaved(std::vector<Timed>& all, int repetitions, double least,
                      const std::function<void(double part)>& progress);

}  // namespace slideway::charts
