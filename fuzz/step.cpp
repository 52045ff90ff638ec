// A random mechanism, disturbed, stepped by any method with any options: steps keep their contract, forces obey
// Coulomb's law, and a copy replays bit for bit.
#include <cstring>
#include <slideway/properties/mechanism.hpp>

#include "support/fail.hpp"
#include "support/steps.hpp"

const char* const slideway::fuzz::target = "step";

namespace {

using namespace slideway;
using namespace slideway::fuzz;
using properties::Choices;

/// Steps as far as they are made.
Report run(const RunStepper& stepper, RunState& state, double dt, int steps) {
  Report report;
  for (int k = 0; k < steps && report.status == Status::ok; ++k) report = step(stepper, state, dt);
  return report;
}

void hold_replay(const RunStepper& stepper, const RunState& start, double dt, int steps) {
  RunState one = start, other = start;
  const Report a = run(stepper, one, dt, steps), b = run(RunStepper(stepper), other, dt, steps);
  const bool same = one == other || std::memcmp(&one, &other, sizeof one) == 0;
  if (!same || a.status != b.status || a.evaluations != b.evaluations || a.uniqueness != b.uniqueness)
    fail("a copy goes elsewhere");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices({data, size});
  const Method method = draw_method(choices);
  const double dt = draw_dt(choices);
  const int steps = 1 + choices.below(4), disturbances = choices.below(4);
  // Options and disturbances come behind the mechanism: bytes that are added at the end change the least.
  const properties::Mechanism mechanism = properties::draw_mechanism(choices);
  RunStepper stepper(mechanism.scene);
  stepper.method = method;
  draw_options(choices, stepper);
  RunState state = stepper.start();
  for (int k = 0; k < disturbances; ++k) disturb(choices, stepper, state);
  hold_coulomb(stepper, state);
  hold_replay(stepper, state, dt, steps);
  if (run(stepper, state, dt, steps).status == Status::ok) hold_coulomb(stepper, state);
  return 0;
}
