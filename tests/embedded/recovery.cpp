#include <cstdio>
#include <limits>
#include <slideway/self_test.hpp>
#include <slideway/step.hpp>

// A rod that a bead carries along a wire with friction (Painleve), pushed by a motor: the controller's model.
using Rod = slideway::Scene<slideway::Size<1, 3, 1, 1, 0, 0, 0, 0, 1, 1>>;
constexpr Rod make_rod(double mu, double angle, double speed) {
  Rod scene;
  scene.gravity = {0, -9.81};
  scene.bodies = scene.guides = scene.loads = scene.inputs = 1;
  scene.body[0].joint = slideway::Joint::planar;
  scene.body[0].mass = 1;
  scene.body[0].com = {1, 0};
  scene.body[0].inertia = 1.0 / 3;
  scene.body[0].q[2] = angle;
  scene.body[0].v[0] = speed;
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  scene.load[0].force = {1, 0};
  scene.load[0].input = 0;  // the motor's force, N
  return scene;
}

enum Way { whole, along_signs, projected, shorter, impulses, brake };
constexpr const char* names[] = {"whole", "along_signs", "projected", "shorter", "impulses", "brake"};

/// The inputs tau later.
template <class Inputs>
Inputs later(const Inputs& inputs, double tau) noexcept {
  Inputs result = inputs;
  for (slideway::Input& input : result.input) {
    const slideway::LawValue at = slideway::value_at(input, tau);
    input = {at.value, at.rate, at.acceleration};
  }
  return result;
}

/// dt in four steps. All or nothing.
template <class Stepper, class State, class Inputs>
bool in_quarters(const Stepper& stepper, State& state, double dt, const Inputs& inputs) noexcept {
  State next = state;
  for (int k = 0; k < 4; ++k) {
    if (stepper.step(next, dt / 4, later(inputs, k * dt / 4)).status != slideway::Status::ok) return false;
  }
  state = next;
  return true;
}

/// One period, by the first way that succeeds. By `brake` the state is as it was.
template <class Stepper, class State, class Inputs>
Way advance(const Stepper& usual, State& state, double dt, const Inputs& inputs) noexcept {
  using slideway::Status;
  State next = state;  // a refused step leaves it as it is, so each way starts from the same
  Way way = whole;
  Status status = usual.step(next, dt, inputs).status;
  if (status == Status::invalid_input) return brake;  // nothing computed from it would be worth more
  if (status == Status::drift_limit) {
    if (usual.project(next, inputs).status != Status::ok) return brake;
    way = projected;
    status = usual.step(next, dt, inputs).status;
  }
  Stepper other = usual;
  if (status == Status::not_unique) {
    way = along_signs;
    other.hlcp.not_unique = slideway::NotUnique::continue_along_signs;
    status = other.step(next, dt, inputs).status;
  }
  if (status != Status::ok && in_quarters(usual, next, dt, inputs)) {
    way = shorter;
    status = Status::ok;
  }
  if (status != Status::ok) {
    way = impulses;
    other.method = slideway::Method::moreau;
    status = other.step(next, dt, inputs).status;
  }
  if (status != Status::ok) return brake;
  state = next;
  return way;
}

/// 400 periods of 1 ms, and how each was made.
template <const auto& scene>
void run(const char* what) {
  slideway::Stepper<scene> stepper;
  stepper.method = slideway::Method::rk4_located;
  auto state = stepper.start();
  int count[6] = {};
  for (int k = 0; k < 400; ++k) {
    slideway::Inputs<Rod::Size> inputs;
    inputs.input[0] = {0.5 - k * 1e-3, -1, 0};                                      // N and N/s, at this period's start
    if (k == 10) inputs.input[0].value = std::numeric_limits<double>::quiet_NaN();  // a broken sensor
    if (k == 20) {  // q and v are set by hand, to what was measured
      state.q[0] += 1e-3;
      state.q[1] += 1e-3;
      state.decided = false;
      stepper.project(state, inputs);
    }
    if (k == 30) state.q[1] += 0.01;  // what a careless hand does: further off the wire than drift_limit
    ++count[advance(stepper, state, 1e-3, inputs)];
  }
  std::printf("%s: at %g s x = %.9g m, angle = %.9g rad\n ", what, state.time(), state.q[0], state.q[2]);
  for (int way = whole; way <= brake; ++way) std::printf(" %s %d", names[way], count[way]);
  std::printf("\n");
}

constexpr Rod mild = make_rod(1.0, 1.4, 4), several = make_rod(1.5, 1.4, 4), none = make_rod(1.5, 1.1, -4);

int main() {
  const slideway::SelfTest damage = slideway::self_test();
  if (damage != slideway::SelfTest::passed) {
    std::printf("self-test: %s\n", name(damage));
    return 1;
  }
  run<mild>("mu 1");
  run<several>("mu 1.5, several answers");
  run<none>("mu 1.5, none");
}
