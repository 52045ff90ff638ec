// A few steps of the kernel, and whether they are what its method's order promises.
#pragma once

#include <slideway/io/stepper.hpp>

#include "atlas.hpp"

namespace slideway::charts {

struct ShortRun {
  io::RunStepper::State state;
  Status status = Status::ok;  ///< of the last step
  long steps = 0;              ///< made
  long events = 0, unlocated = 0;
  double drift = 0;  ///< largest that the reports say
  EnergyFlow flow;
  Uniqueness uniqueness = Uniqueness::certified;
};

/// Until `steps` are made, or one is refused.
ShortRun short_run(const io::RunStepper& stepper, const io::RunStepper::State& from, double dt, long steps);

/// Largest |q_a - q_b|, angles times the scene's length.
double distance(const io::RunStepper& stepper, const io::RunStepper::State& a, const io::RunStepper::State& b);

/// Whether an answered run is off by at most ten times what its order promises: of an order 1 or more, twice what
/// halving the step changes, and of a located method, which halves long steps itself, a third, too. The truth is
/// dop853_located with an eighth of the step, its own error twice what doubling that changes; and rounding. Where one
/// of the other runs is refused there is no promise: true.
bool keeps_its_promise(const io::RunStepper& stepper, const io::RunStepper::State& from, double dt,
                       const ShortRun& made);

}  // namespace slideway::charts
