// What holds of every call of a stepper: the calls, held to their contracts. And what steppers are asked with.
#pragma once

#include <slideway/properties/choices.hpp>
#include <slideway/properties/step.hpp>

namespace slideway::fuzz {

using io::RunStepper;
using properties::RunState;
using RunInputs = RunStepper::Inputs;

/// A step: refused and nothing changed, or advanced; every number that is handed out is finite.
Report step(const RunStepper& stepper, RunState& state, double dt, const RunInputs& inputs = {});

/// Forces at a state: refused, or all finite. Coulomb's law in them is properties::coulomb().
Report reaction(const RunStepper& stepper, const RunState& state, const RunInputs& inputs = {});

/// A projection: refused and nothing changed, or nothing but q and v, and no drift is left that a step would refuse.
Report project(const RunStepper& stepper, RunState& state, const RunInputs& inputs = {});

/// Coulomb's law at a state that a step has made or that is not decided.
void hold_coulomb(const RunStepper& stepper, const RunState& state);

Method draw_method(properties::Choices& choices);
/// Most often a usual step, at times anything.
double draw_dt(properties::Choices& choices);
/// Every option; used-up choices leave them as they are, but for max_solves, which is small: fuzzing has no time.
void draw_options(properties::Choices& choices, RunStepper& stepper);
/// Changes q or v by anything from a rounding on, or makes one of them any double.
void disturb(properties::Choices& choices, const RunStepper& stepper, RunState& state);

}  // namespace slideway::fuzz
