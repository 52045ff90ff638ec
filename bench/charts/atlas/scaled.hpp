// The same mechanism in other units.
#pragma once

#include "short_run.hpp"

namespace slideway::charts {

/// One metre, kilogram and second in the new units.
struct Units {
  double m, kg, s;
  /// Of a quantity of dimension m^a kg^b s^c.
  double of(int a, int b, int c) const;
};

RunScene in_units(RunScene scene, const Units& units);

/// Numbers of a state and its forces, back in SI.
std::vector<double> in_si(const io::RunStepper& stepper, const io::RunStepper::State& state, const Units& units);

}  // namespace slideway::charts
