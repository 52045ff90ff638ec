#include <slideway/scenes/crank_rocker_offset.hpp>

#include "detail_models.hpp"

namespace slideway::charts {
namespace {

constexpr auto offset_point = with_point_slider(crank_rocker_offset);

}  // namespace

Machine undriven_machine() {
  Machine machine{"crank_rocker_offset", false, 140, 1e-3, {}, {}};
  const auto all_planar = with_planar_bodies(crank_rocker_offset);
  machine.most_detailed = [=] {
    Answer answer;
    const auto stepper = run_time(all_planar);
    stepper->method = Method::dop853_located;
    run_model(*stepper, 4 * 140, 1e-3 / 4, 4 * 140 / looks, &answer);
    return answer;
  };
  add_model(machine, "planar bodies and pins", planar(integrated), Method::rk4, run_time(all_planar));
  add_model(machine, "tree, two contacts", two_contacts(integrated), Method::rk4, run_time(crank_rocker_offset));
  add_model(machine, "the same, compile time", two_contacts(known), Method::rk4, compile_time<crank_rocker_offset>());
  add_model(machine, "tree, two, no friction", two_contacts(smooth), Method::rk4,
            run_time(without_friction(crank_rocker_offset)));
  add_model(machine, "point slider", point(integrated), Method::rk4, run_time(offset_point));
  add_model(machine, "point, compile time", point(known), Method::rk4, compile_time<offset_point>());
  add_model(machine, "point, no friction", point(smooth), Method::rk4, run_time(without_friction(offset_point)));
  return machine;
}

}  // namespace slideway::charts
