#include <cstdio>
#include <slideway/scenes/crank_rocker.hpp>  // slideway export crank_rocker -o slideway/scenes/crank_rocker.hpp
#include <slideway/step.hpp>

int main() {
  constexpr slideway::Stepper<crank_rocker> stepper{};  // options are members with defaults
  auto state = stepper.start();                         // plain data: copy it to save it
  for (int k = 0; k < 1000; ++k) {
    const slideway::Report report = stepper.step(state, 1e-3);
    if (report.status != slideway::Status::ok) {  // the state is untouched
      std::printf("t = %g s: %s\n", state.time(), sentence(report.status));
      return 1;
    }
  }
  decltype(stepper)::Reaction reaction;
  if (stepper.reaction(state, {}, reaction).status != slideway::Status::ok) return 1;
  std::printf("t = %g s: lambda = %.9g N, torque = %.9g N m\n", state.time(),
              reaction.lambda[crank_rocker_index::contact_slot], reaction.drive[crank_rocker_index::drive_motor]);
}
