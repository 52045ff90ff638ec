// Error and time of contenders, by one program in one run.
#pragma once

#include <functional>
#include <slideway/oracle/reference.hpp>
#include <string>
#include <vector>

#include "contender.hpp"

namespace slideway::charts {

/// One contender at one setting.
struct Measured {
  const Contender* contender;
  double setting;
  std::string failure;     ///< empty: it went through
  double error = 0;        ///< of positions: max |q - q_ref| over the samples, over the largest |q_ref|
  double force_error = 0;  ///< of contact forces, likewise
  long evaluations = 0;
  double ns = 0, ns_low = 0, ns_high = 0;  ///< for each simulated second: median, least and most of the repetitions
};

struct MeasureOptions {
  double longest = 0.3;  ///< s that one run may take: finer settings are left out
  int repetitions = 5;
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// Runs every contender from coarse to fine, and times those that are not beaten by far in their own family.
std::vector<Measured> measure(const Contenders& contenders, const oracle::Reference& reference,
                              const MeasureOptions& options);

/// The cheapest of a family that comes below an error; null if none does.
const Measured* cheapest(const std::vector<Measured>& all, const std::function<bool(const Contender&)>& among,
                         double error);

}  // namespace slideway::charts
