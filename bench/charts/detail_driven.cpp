#include <slideway/scenes/slider_crank_driven.hpp>

#include "detail_models.hpp"

namespace slideway::charts {
namespace {

constexpr auto driven_point = with_point_slider(slider_crank_driven);

}  // namespace

Machine driven_machine() {
  Machine machine{"slider_crank_driven", 1000, 1e-3, {}, {}};
  const auto planar = with_planar_bodies(slider_crank_driven);
  machine.most_detailed = [=] {
    Answer answer;
    const auto stepper = run_time(planar);
    stepper->method = Method::kinematic;
    run_model(*stepper, 1000, 1e-3, 1000 / looks, &answer);
    return answer;
  };
  const Style two{two_contacts_colour, integrated_marker, false}, point{point_colour, integrated_marker, false};
  const Style two_kinematic{two_contacts_colour, kinematic_marker, false};
  const Style point_kinematic{point_colour, kinematic_marker, false};
  add_model(machine, "planar bodies and pins", {planar_colour, integrated_marker, false}, Method::rk4,
            run_time(planar));
  add_model(machine, "planar, kinematic", {planar_colour, kinematic_marker, false}, Method::kinematic,
            run_time(planar));
  add_model(machine, "tree, two contacts", two, Method::rk4, run_time(slider_crank_driven));
  add_model(machine, "the same, compile time", two, Method::rk4, compile_time<slider_crank_driven>());
  add_model(machine, "tree, two, kinematic", two_kinematic, Method::kinematic, run_time(slider_crank_driven));
  add_model(machine, "tree, two, no friction", {two_contacts_colour, smooth_marker, false}, Method::rk4,
            run_time(without_friction(slider_crank_driven)));
  add_model(machine, "point slider", point, Method::rk4, run_time(driven_point));
  add_model(machine, "point, compile time", point, Method::rk4, compile_time<driven_point>());
  add_model(machine, "point, kinematic", point_kinematic, Method::kinematic, run_time(driven_point));
  add_model(machine, "point, kinematic, compile time", point_kinematic, Method::kinematic,
            compile_time<driven_point>());
  add_model(machine, "point, no friction", {point_colour, smooth_marker, false}, Method::rk4,
            run_time(without_friction(driven_point)));
  return machine;
}

}  // namespace slideway::charts
