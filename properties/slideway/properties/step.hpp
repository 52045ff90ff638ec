// What must hold of every state that a step has made, and of its forces: Coulomb's law by the numbers handed out, and
// the oracle's own answer. For an own scene: start anywhere, step, and ask.
#pragma once

#include <slideway/io/stepper.hpp>
#include <string>

namespace slideway::properties {

using io::RunStepper;
using RunState = RunStepper::State;

/// Empty if it holds, else what does not, with its numbers.
using Violation = std::string;

/// Coulomb's law at a state, in the forces of stepper.reaction(): |F + viscous v| <= mu_static Lambda + preload; where
/// a guide slips F + viscous v = -sgn(v) (mu Lambda + preload), which does no work on the slip; a guide whose mode is
/// rest has no speed but drift. To 2^-39 of the largest force, some thousand roundings: twice what the kernel lets the
/// friction of a guide at rest exceed its limit by. Nothing where the reaction is
/// refused.
Violation coulomb(const RunStepper& stepper, const RunState& state);

/// A refusal left every byte of `before`; an answer is finite, advanced, and its friction dissipated: not less than 0,
/// but for 2^-40 of all energy that crossed the border and what rounding moves. Located methods freeze modes in their
/// stages, and dop853_located has negative weights: these may give what they err by, which is at most twice what
/// 16 steps in its place change if these err by half as much or less; 128, then 1024, while each is longer than
/// 1 / (alpha + sqrt(beta)), which Baumgarte's terms need. Nothing is asked where one of them is refused.
Violation step_contract(const RunStepper& stepper, const RunState& before, const RunState& after, const Report& report,
                        double dt, const RunStepper::Inputs& inputs = {});

/// Largest load or weight of a scene, N, and 1e-3 N: what forces near zero are measured by.
double typical_force(const Scene<io::RunSize>& scene);

/// The forces and accelerations at a state held against the oracle's, which tries every mode in 50 digits; its own
/// bound for what rounding the state brings, or 1e-13 of typical forces where terms cancel. `answered`: there was
/// something to compare. Not for a state that is beside a limit by no more than rounding: what holds before and after
/// it is then right. Milliseconds to seconds: 3^guides 2^contacts modes.
struct InstantJudgement {
  bool answered = false;
  Violation violation;
};
InstantJudgement judge_instant(const RunStepper& stepper, const RunState& state);

}  // namespace slideway::properties
