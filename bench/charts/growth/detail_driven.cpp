#include <slideway/scenes/slider_crank_driven.hpp>

#include "detail_models.hpp"

namespace slideway::charts {
namespace {

constexpr auto driven_point = with_point_slider(slider_crank_driven);

}  // namespace

Machine driven_machine() {
  Machine machine{"slider_crank_driven", true, 1000, 1e-3, {}, {}};
  const auto all_planar = with_planar_bodies(slider_crank_driven);
  machine.most_detailed = [=] {
    Answer answer;
    const auto stepper = run_time(all_planar);
    stepper->method = Method::kinematic;
    run_model(*stepper, 1000, 1e-3, 1000 / looks, &answer);
    return answer;
  };
  add_model(machine, "planar bodies and pins", planar(integrated), Method::rk4, run_time(all_planar));
  add_model(machine, "planar, kinematic", planar(by_kinematics), Method::kinematic, run_time(all_planar));
  add_model(machine, "tree, two contacts", two_contacts(integrated), Method::rk4, run_time(slider_crank_driven));
  add_model(machine, "the same, compile time", two_contacts(known), Method::rk4, compile_time<slider_crank_driven>());
  add_model(machine, "tree, two, kinematic", two_contacts(by_kinematics), Method::kinematic,
            run_time(slider_crank_driven));
  add_model(machine, "tree, two, no friction", two_contacts(smooth), Method::rk4,
            run_time(without_friction(slider_crank_driven)));
  add_model(machine, "point slider", point(integrated), Method::rk4, run_time(driven_point));
  add_model(machine, "point, compile time", point(known), Method::rk4, compile_time<driven_point>());
  add_model(machine, "point, kinematic", point(by_kinematics), Method::kinematic, run_time(driven_point));
  add_model(machine, "point, kinematic, compile time", point(known_kinematics), Method::kinematic,
            compile_time<driven_point>());
  add_model(machine, "point, no friction", point(smooth), Method::rk4, run_time(without_friction(driven_point)));
  return machine;
}

}  // namespace slideway::charts
