// What `slideway verify` finds: quantity by quantity, a run of the kernel beside the oracle.
#pragma once

#include <string>
#include <vector>

#include "kernel_run.hpp"

namespace slideway::app {

/// One quantity: the worst of its errors, and what it may be. Held if error <= bound.
struct Check {
  std::string quantity, unit;
  double error = 0;  ///< of `unit`; a count, if there is no scale
  double scale = 0;  ///< largest magnitude of the kind; 0: the error counts violations
  double bound = 0;
  bool bound_grows = false;     ///< with the run's own error: beyond the scale it says nothing, and does not hold
  double t = 0;                 ///< where the error is worst, s
  std::vector<double> curve{};  ///< the error at each sample, for the chart; empty if there is none

  bool held() const { return error <= bound && !(bound_grows && bound >= scale); }
  bool counts() const { return scale == 0; }
  /// Decimal digits that both share: -log10 of the relative error, at most those of a double.
  double digits() const { return shared(error); }
  double digits_needed() const { return shared(bound); }

 private:
  double shared(double x) const;
};

/// Checks of one kind, and what they compare with.
struct CheckGroup {
  std::string title, explanation;
  std::vector<Check> checks;
};

struct Verification {
  KernelRun run;
  std::vector<CheckGroup> groups;
  double acceleration_bound = 0;         ///< of what rounding makes of accelerations, largest at any state
  std::vector<std::string> not_checked;  ///< each a sentence
  double reference_digits = 0;           ///< shared by two trajectories of the oracle
  long reference_steps = 0;
  std::vector<Event> reference_events;
  std::string reference_end;  ///< why the trajectory is no reference for the whole run; "" if it is

  bool held() const;
};

/// At states of the run: the equations solved by the oracle.
CheckGroup check_states(const Preparation& prepared, Verification& verification, Progress& progress);

/// Steps of the method in exact arithmetic from states of the run, and the drift against its bound.
CheckGroup check_steps(const Preparation& prepared, Verification& verification, Progress& progress);

/// The run against the oracle's trajectory.
CheckGroup check_motion(const Preparation& prepared, Verification& verification, Progress& progress);

/// Every bound that has a scale becomes what `digits` decimal digits ask for.
void ask_for_digits(Verification& verification, double digits);

}  // namespace slideway::app
