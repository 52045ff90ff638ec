// Edits of a scene that make it more or less detailed, and its steppers as models of a machine.
#pragma once

#include <cmath>
#include <memory>
#include <slideway/step.hpp>
#include <stdexcept>
#include <tuple>

#include "detail.hpp"

namespace slideway::charts {

/// Room for three bodies of which the last does not turn on the one that carries it.
template <int drives>
using PointSize = Size<3, 2, 1, 1, drives, 0, 0, 0, 0, 0>;

/// The slider, the last of three bodies in a tree, is a point on the body that carries it: it no longer turns on that,
/// so its inertia is left out, too.
template <class Size>
constexpr auto with_point_slider(const Scene<Size>& tree) {
  Scene<PointSize<Size::drives>> scene;
  scene.gravity = tree.gravity;
  scene.alpha = tree.alpha;
  scene.beta = tree.beta;
  scene.bodies = tree.bodies;
  scene.guides = tree.guides;
  scene.drives = tree.drives;
  for (int i = 0; i < tree.bodies; ++i) scene.body[i] = tree.body[i];
  scene.guide[0] = tree.guide[0];
  if (tree.drives > 0) scene.drive[0] = tree.drive[0];
  Guide& guide = scene.guide[0];
  Body& slider = scene.body[guide.slider];
  slider.joint = Joint::fixed;
  slider.inertia = 0;
  guide.contacts = 1;
  guide.contact[0] = {};
  return scene;
}

template <class Size>
constexpr Scene<Size> without_friction(Scene<Size> scene) {
  scene.guide[0].mu = scene.guide[0].mu_static = 0;
  return scene;
}

/// Room for every body of three as a planar one, each pinned to what carried it.
using PlanarSize = Size<3, 9, 1, 2, 1, 3, 0, 0, 0, 0>;

/// Revolute bodies as planar ones: x, y and angle each, and a pin where the joint was.
template <class Size>
Scene<PlanarSize> with_planar_bodies(const Scene<Size>& tree) {
  Scene<PlanarSize> scene;
  scene.gravity = tree.gravity;
  scene.alpha = tree.alpha;
  scene.beta = tree.beta;
  scene.bodies = scene.pins = tree.bodies;
  scene.guides = tree.guides;
  scene.drives = tree.drives;
  scene.guide[0] = tree.guide[0];
  if (tree.drives > 0) {
    scene.drive[0] = tree.drive[0];
    scene.drive[0].axis = 2;  // of a crank on the ground: its angle is the joint's
  }
  for (int i = 0; i < tree.bodies; ++i) {
    const Body& of = tree.body[i];
    Body body = of;
    const Body ground_body;
    const Body& parent = of.parent == ground ? ground_body : scene.body[of.parent];
    const Vec2 arm = of.parent == ground ? of.at : Rotation{std::cos(parent.q[2]), std::sin(parent.q[2])} * of.at;
    const Vec2 turning = parent.v[2] * perp(arm);
    body.parent = ground;
    body.joint = Joint::planar;
    body.at = {};
    for (const auto& [coordinate, place, speed] : {std::tuple{0, parent.q[0] + arm.x, parent.v[0] + turning.x},
                                                   std::tuple{1, parent.q[1] + arm.y, parent.v[1] + turning.y},
                                                   std::tuple{2, parent.q[2] + of.q[0], parent.v[2] + of.v[0]}}) {
      body.q[coordinate] = place;
      body.v[coordinate] = speed;
    }
    scene.body[i] = body;
    scene.pin[i] = {i, of.parent, {}, of.at};
  }
  return scene;
}

/// Runs `steps` steps of dt, and looks at each `every`th if `answer` is not null.
template <class Source>
void run_model(const BasicStepper<Source>& stepper, int steps, double dt, int every, Answer* answer) {
  auto state = stepper.start();
  for (int k = 1; k <= steps; ++k) {
    if (stepper.step(state, dt).status != Status::ok) throw std::runtime_error("a step was refused");
    if (answer == nullptr || k % every != 0) continue;
    typename BasicStepper<Source>::Reaction r;
    if (stepper.reaction(state, {}, r).status != Status::ok) throw std::runtime_error("a reaction was refused");
    Kinematics<typename Source::Size> kin;
    const double no_prescribed[at_least_one(Source::Size::coordinates)] = {};
    kinematics(stepper.source, state.q, state.v, no_prescribed, kin);
    const Vec2 place = kin.origin[stepper.source.scene.guide[0].slider];
    answer->place.insert(answer->place.end(), {place.x, place.y});
    answer->normal.push_back(stepper.source.scene.guide[0].contacts == 2 ? r.lambda[0] + r.lambda[1] : r.lambda[0]);
    if (stepper.source.scene.drives > 0) answer->torque.push_back(r.drive[0]);
  }
}

inline constexpr int looks = 20;  ///< at a run

/// Adds a stepper to a machine's models.
template <class Source>
void add_model(Machine& machine, const std::string& name, Style style, Method method,
               std::shared_ptr<BasicStepper<Source>> stepper) {
  stepper->method = method;
  const int steps = machine.steps;
  const double dt = machine.dt;
  machine.models.push_back({name, style,
                            [=] {
                              Answer answer;
                              run_model(*stepper, steps, dt, steps / looks, &answer);
                              return answer;
                            },
                            [=] { run_model(*stepper, steps, dt, steps, nullptr); }});
}

template <class Size>
std::shared_ptr<BasicStepper<RunTime<Size>>> run_time(const Scene<Size>& scene) {
  return std::make_shared<BasicStepper<RunTime<Size>>>(scene);
}

template <const auto& scene>
std::shared_ptr<Stepper<scene>> compile_time() {
  return std::make_shared<Stepper<scene>>();
}

// Colours tell coordinates and contacts.
constexpr Style planar(int marker) { return {1, marker, false}; }
constexpr Style two_contacts(int marker) { return {0, marker, false}; }
constexpr Style point(int marker) { return {2, marker, false}; }
// Markers tell the rest.
inline constexpr int integrated = 0, known = 5, by_kinematics = 2, known_kinematics = 3, smooth = 4;

}  // namespace slideway::charts
