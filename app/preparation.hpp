// From the options of a command to a stepper at its start: what run and verify share.
#pragma once

#include <memory>
#include <optional>
#include <slideway/io/stepper.hpp>

#include "recording.hpp"

namespace slideway::app {

struct StepOptions;

using RunState = State<io::RunSize>;
using RunStepper = RunTimeStepper<io::RunSize>;
using RunInputs = Inputs<io::RunSize>;

/// How a duration is cut into steps. The last one ends at the duration: it is shorter, unless what is missing or too
/// much is rounding of the quotient.
struct Plan {
  long long steps = 0;
  double dt = 0, last_dt = 0;

  Plan(double duration, double step);
  double of(long long step) const noexcept { return step == steps - 1 ? last_dt : dt; }
};

struct Preparation {
  Recording recording;  ///< what is asked for; nothing has happened yet
  std::unique_ptr<RunStepper> stepper;
  RunInputs inputs;
  RunState start;
  Plan plan;
};

/// Nothing, and said, when the options are not good together: `status` is then bad_input, or refused when the start
/// cannot be moved onto the constraints.
std::optional<Preparation> prepare(const StepOptions& options, int& status);

}  // namespace slideway::app
