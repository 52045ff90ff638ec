// Any sequence of calls on one stepper, as a controller may make it: each keeps its contract, and none changes an
// option.
#include <cstring>
#include <slideway/properties/mechanism.hpp>

#include "support/fail.hpp"
#include "support/steps.hpp"

const char* const slideway::fuzz::target = "calls";

namespace {

using namespace slideway;
using namespace slideway::fuzz;
using properties::Choices;

constexpr int most_calls = 24;

/// Some loads scaled and some drives led by inputs.
void draw_inputs(Choices& choices, properties::MechanismScene& scene) {
  scene.inputs = 2;
  for (int l = 0; l < scene.loads; ++l) {
    if (choices.flag()) scene.load[l].input = 0;
  }
  for (int d = 0; d < scene.drives; ++d) {
    if (!choices.flag()) continue;
    scene.drive[d].law = Law::input;
    scene.drive[d].input = 1;
  }
}

void set_input(Choices& choices, Input& input) {
  double& x = choices.below(3) == 0 ? input.value : choices.flag() ? input.rate : input.acceleration;
  x = choices.below(8) == 1 ? choices.any_double() : choices.dyadic(5);
}

/// What is called on, and a state that was saved.
struct Caller {
  RunStepper stepper;
  RunState state, saved;
  RunInputs inputs = {};
  bool edited = false;  ///< q or v were set by hand, and modes are still those from before

  void call(Choices& choices) {
    switch (choices.below(10)) {
      case 0:
      case 1:
      case 2:
        if (step(stepper, state, draw_dt(choices), inputs).status == Status::ok) edited = false;
        break;
      case 3:
        stepper.method = draw_method(choices);
        break;
      case 4:
        set_input(choices, inputs.input[choices.below(2)]);
        break;
      case 5:
        reaction(stepper, state, inputs);
        if (!edited) hold_coulomb(stepper, state);
        break;
      case 6:
        project(stepper, state, inputs);
        edited = true;
        break;
      case 7:
        disturb(choices, stepper, state);
        edited = true;
        break;
      case 8:
        state.decided = edited = false;
        break;
      case 9:
        if (choices.flag())
          saved = state;
        else
          state = saved;
        edited = true;
    }
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices({data, size});
  const bool has_inputs = choices.flag();
  properties::Mechanism mechanism = properties::draw_mechanism(choices);
  if (has_inputs) draw_inputs(choices, mechanism.scene);
  RunStepper stepper(mechanism.scene);
  draw_options(choices, stepper);
  Caller caller{stepper, stepper.start(), stepper.start()};
  std::memcpy(&stepper, &caller.stepper, sizeof stepper);  // padding too
  for (int k = 0; k < most_calls && !choices.used_up(); ++k) caller.call(choices);
  caller.stepper.method = stepper.method;
  if (std::memcmp(&stepper, &caller.stepper, sizeof stepper) != 0) fail("a call has changed an option");
  return 0;
}
