#include <slideway/scenes/crank_rocker_offset.hpp>

#include "detail_models.hpp"

namespace slideway::charts {
namespace {

constexpr auto offset_point = with_point_slider(crank_rocker_offset);

}  // namespace

Machine undriven_machine() {
  Machine machine{"crank_rocker_offset", 140, 1e-3, {}, {}};
  const auto planar = with_planar_bodies(crank_rocker_offset);
  machine.most_detailed = [=] {
    Answer answer;
    const auto stepper = run_time(planar);
    stepper->method = Method::dop853_located;
    run_model(*stepper, 4 * 140, 1e-3 / 4, 4 * 140 / looks, &answer);
    return answer;
  };
  const Style two{two_contacts_colour, integrated_marker, false}, point{point_colour, integrated_marker, false};
  add_model(machine, "planar bodies and pins", {planar_colour, integrated_marker, false}, Method::rk4,
            run_time(planar));
  add_model(machine, "tree, two contacts", two, Method::rk4, run_time(crank_rocker_offset));
  add_model(machine, "the same, compile time", two, Method::rk4, compile_time<crank_rocker_offset>());
  add_model(machine, "tree, two, no friction", {two_contacts_colour, smooth_marker, false}, Method::rk4,
            run_time(without_friction(crank_rocker_offset)));
  add_model(machine, "point slider", point, Method::rk4, run_time(offset_point));
  add_model(machine, "point, compile time", point, Method::rk4, compile_time<offset_point>());
  add_model(machine, "point, no friction", {point_colour, smooth_marker, false}, Method::rk4,
            run_time(without_friction(offset_point)));
  return machine;
}

}  // namespace slideway::charts
