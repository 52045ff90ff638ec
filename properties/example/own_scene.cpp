// How to hold your own scene to the properties: what a user writes is between the lines. Random speeds and loads around
// those of the file; every step must hold its contract and Coulomb's law, and the oracle must agree.
#include <slideway/properties/rapidcheck.hpp>
#include <slideway/properties/step.hpp>

namespace {

using namespace slideway;
using namespace slideway::properties;

const io::SceneFile scene_file = [] {
  const io::Reading reading = io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/overhung_slider.toml");
  return *reading.scene;
}();

// ---- what a user writes --------------------------------------------------------------------------------------------

RC_GTEST_PROP(OwnScene, HoldsToTheProperties, ()) {
  auto scene = scene_file.scene;
  scene.body[0].v[0] = *rc::gen::inRange(-64, 65) / 32.0;
  scene.load[0].torque = *rc::gen::inRange(-16, 17) / 32.0;
  RunStepper stepper(scene);
  stepper.method = Method::rk4_located;
  RunState state = stepper.start();
  for (int k = 0; k < 20; ++k) {
    const RunState before = state;
    const Report report = stepper.step(state, 1e-3);
    RC_ASSERT(step_contract(stepper, before, state, report, 1e-3) == "");
    if (report.status != Status::ok) break;
    RC_ASSERT(coulomb(stepper, state) == "");
  }
  RC_ASSERT(judge_instant(stepper, state).violation == "");
}

// --------------------------------------------------------------------------------------------------------------------

}  // namespace
