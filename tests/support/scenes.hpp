// Every shipped scene, as the compiler knows it and as a program that runs meets it.
#pragma once

#include <slideway/scenes/belt.hpp>
#include <slideway/scenes/block_on_plane.hpp>
#include <slideway/scenes/crank_rocker.hpp>
#include <slideway/scenes/crank_rocker_free.hpp>
#include <slideway/scenes/crank_rocker_offset.hpp>
#include <slideway/scenes/crank_rocker_two_contacts.hpp>
#include <slideway/scenes/crank_rocker_weightless.hpp>
#include <slideway/scenes/elliptic_trammel.hpp>
#include <slideway/scenes/four_bar_chain.hpp>
#include <slideway/scenes/gantry.hpp>
#include <slideway/scenes/high_mass_ratio.hpp>
#include <slideway/scenes/overhung_slider.hpp>
#include <slideway/scenes/painleve_klein.hpp>
#include <slideway/scenes/painleve_rod.hpp>
#include <slideway/scenes/pushed_block.hpp>
#include <slideway/scenes/quick_return.hpp>
#include <slideway/scenes/rod_on_two_guides.hpp>
#include <slideway/scenes/slider_crank.hpp>
#include <slideway/scenes/slider_crank_driven.hpp>
#include <slideway/scenes/slider_crank_equal.hpp>
#include <slideway/scenes/squeezer.hpp>
#include <slideway/scenes/three_contacts.hpp>
#include <slideway/scenes/trammel_at_rest.hpp>
#include <slideway/scenes/v_engine_16.hpp>
#include <slideway/scenes/v_engine_2.hpp>
#include <slideway/scenes/v_engine_4.hpp>
#include <slideway/scenes/v_engine_8.hpp>
#include <slideway/step.hpp>

namespace slideway::test {

/// Room for all of them.
using WideSize = Size<33, 33, 16, 32, 4, 4, 2, 2, 2, 2>;

/// The same scene with room to spare.
template <class Exact>
constexpr Scene<WideSize> widen(const Scene<Exact>& scene) {
  Scene<WideSize> wide;
  wide.gravity = scene.gravity;
  wide.alpha = scene.alpha;
  wide.beta = scene.beta;
  const auto copy = [](const auto& from, auto& to, int count, int& to_count) {
    for (int i = 0; i < count; ++i) to[i] = from[i];
    to_count = count;
  };
  copy(scene.body, wide.body, scene.bodies, wide.bodies);
  copy(scene.guide, wide.guide, scene.guides, wide.guides);
  copy(scene.drive, wide.drive, scene.drives, wide.drives);
  copy(scene.pin, wide.pin, scene.pins, wide.pins);
  copy(scene.spring, wide.spring, scene.springs, wide.springs);
  copy(scene.joint_spring, wide.joint_spring, scene.joint_springs, wide.joint_springs);
  copy(scene.load, wide.load, scene.loads, wide.loads);
  wide.inputs = scene.inputs;
  return wide;
}

/// f(name, stepper of the compile-time scene, its dt in s, steps of a short run): dt as in the scene's [run].
template <class F>
void for_each_scene(F&& f) {
  f("belt", Stepper<belt>{}, 1e-3, 400);
  f("block_on_plane", Stepper<block_on_plane>{}, 1e-3, 600);
  f("crank_rocker", Stepper<crank_rocker>{}, 1e-3, 400);
  f("crank_rocker_free", Stepper<crank_rocker_free>{}, 1e-3, 400);
  f("crank_rocker_offset", Stepper<crank_rocker_offset>{}, 1e-3, 400);
  f("crank_rocker_two_contacts", Stepper<crank_rocker_two_contacts>{}, 1e-3, 400);
  f("crank_rocker_weightless", Stepper<crank_rocker_weightless>{}, 1e-3, 400);
  f("elliptic_trammel", Stepper<elliptic_trammel>{}, 1e-3, 400);
  f("four_bar_chain", Stepper<four_bar_chain>{}, 1e-3, 400);
  f("gantry", Stepper<gantry>{}, 1e-3, 400);
  f("high_mass_ratio", Stepper<high_mass_ratio>{}, 1e-3, 400);
  f("overhung_slider", Stepper<overhung_slider>{}, 1e-3, 400);
  f("painleve_klein", Stepper<painleve_klein>{}, 1e-3, 400);
  f("painleve_rod", Stepper<painleve_rod>{}, 1e-3, 400);
  f("pushed_block", Stepper<pushed_block>{}, 1e-3, 400);
  f("quick_return", Stepper<quick_return>{}, 1e-3, 400);
  f("rod_on_two_guides", Stepper<rod_on_two_guides>{}, 1e-3, 100);
  f("slider_crank", Stepper<slider_crank>{}, 1e-5, 400);
  f("slider_crank_driven", Stepper<slider_crank_driven>{}, 1e-3, 400);
  f("slider_crank_equal", Stepper<slider_crank_equal>{}, 1e-3, 290);
  f("squeezer", Stepper<squeezer>{}, 5e-6, 400);
  f("three_contacts", Stepper<three_contacts>{}, 1e-3, 1);  // made to be refused
  f("trammel_at_rest", Stepper<trammel_at_rest>{}, 1e-3, 400);
  f("v_engine_2", Stepper<v_engine_2>{}, 5e-5, 400);
  f("v_engine_4", Stepper<v_engine_4>{}, 5e-5, 400);
  f("v_engine_8", Stepper<v_engine_8>{}, 5e-5, 200);
  f("v_engine_16", Stepper<v_engine_16>{}, 5e-5, 100);
}

}  // namespace slideway::test
