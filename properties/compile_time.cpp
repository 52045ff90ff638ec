// A scene that the compiler knows and the same scene from its file step to the same bits, from wherever they start.
#include <slideway/properties/rapidcheck.hpp>
#include <slideway/scenes/belt.hpp>
#include <slideway/scenes/crank_rocker_offset.hpp>
#include <slideway/scenes/slider_crank.hpp>
#include <slideway/scenes/trammel_at_rest.hpp>
#include <string>

namespace {

using namespace slideway;
using namespace slideway::properties;
using io::RunStepper;

RunStepper from_file(const std::string& name) {
  const auto reading = io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml");
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return RunStepper(reading.scene ? reading.scene->scene : Scene<io::RunSize>{});
}

template <const auto& scene>
void hold(const std::string& name) {
  Stepper<scene> known;
  RunStepper read = from_file(name);
  known.method = read.method = *rc::gen::elementOf(std::vector<Method>(std::begin(methods), std::end(methods)));
  known.stabilise = read.stabilise = *rc::gen::element(Stabilise::baumgarte, Stabilise::projection);
  auto state = known.start();
  auto other = read.start();
  const int n = Stepper<scene>::Size::coordinates;
  if (*rc::gen::arbitrary<bool>()) {  // off the constraints, at any speed
    const auto parts = *rc::gen::container<std::vector<int>>(2 * n, rc::gen::inRange(-1024, 1025));
    for (int j = 0; j < n; ++j) {
      state.q[j] = other.q[j] += 0x1p-22 * parts[j];
      state.v[j] = other.v[j] += 0x1p-10 * parts[n + j];
    }
  }
  for (int k = 0; k < 8; ++k) {
    const double dt = *rc::gen::element(1e-3, 1e-5, 0x1p-6);
    const Report a = known.step(state, dt), b = read.step(other, dt);
    RC_ASSERT(a.status == b.status);
    RC_ASSERT(a.events == b.events);
    RC_ASSERT(a.uniqueness == b.uniqueness);
    RC_ASSERT(a.energy.dissipated == b.energy.dissipated);
    for (int j = 0; j < n; ++j) {
      RC_ASSERT(state.q[j] == other.q[j]);
      RC_ASSERT(state.v[j] == other.v[j]);
    }
  }
}

RC_GTEST_PROP(CompileTime, BeltIsTheSame, ()) { hold<belt>("belt"); }
RC_GTEST_PROP(CompileTime, CrankRockerIsTheSame, ()) { hold<crank_rocker_offset>("crank_rocker_offset"); }
RC_GTEST_PROP(CompileTime, SliderCrankIsTheSame, ()) { hold<slider_crank>("slider_crank"); }
RC_GTEST_PROP(CompileTime, TrammelAtRestIsTheSame, ()) { hold<trammel_at_rest>("trammel_at_rest"); }

}  // namespace
