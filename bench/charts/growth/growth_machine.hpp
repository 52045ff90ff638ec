// Mechanisms with n sliders, in room for exactly n.
//
//   star    n rods on one crank, the point at each rod's end on a way through the crank's bearing: driven, every rod
//           is a part of its own; undriven, the crank's angle ties all together
//   levers  n + 1 levers in a row, the point at each one's end in a slot of the next through its bearing; the first is
//           rocked, and the forces of all others pass through it: one part, in which each slider meets its neighbours
#pragma once

#include <cmath>
#include <memory>
#include <slideway/step.hpp>

#include "growth.hpp"
#include "stack.hpp"

namespace slideway::charts {

template <int n>
using GrowthSize = Size<n + 1, n + 1, n, n, 1, 0, 0, 0, 0, 0>;
template <int n>
using GrowthScene = Scene<GrowthSize<n>>;
template <int n>
using GrowthState = State<GrowthSize<n>>;

inline constexpr double crank_length = 0.153, rod_length = 0.306;  // m; of slider_crank, as are masses and inertias
inline constexpr double crank_start = 0.3, crank_rate = 100;       // rad, rad/s
inline constexpr double lever_length = 0.5, lever_distance = 1;    // m
inline constexpr double rocked_from = 0.35, rocked_by = 0.2, rocked_at = 10;  // rad, rad, rad/s
inline constexpr double growth_mu = 0.05;

/// The angle of throw i on the crank by the tangent of its half, so that its direction needs no trigonometry and the
/// compiler can know it. Nearly even: 5/4 u / (1 - u^2) is near tan(pi u / 2).
constexpr double half_tangent(int i, int n) {
  const double u = (2.0 * i + 1) / n - 1;
  return 1.25 * u / (1 - u * u);
}

template <int n>
constexpr GrowthScene<n> star(bool driven) {
  GrowthScene<n> scene;
  scene.bodies = n + 1;
  scene.guides = n;
  scene.gravity = {0, -9.81};
  Body& crank = scene.body[0];
  crank.mass = 0.038;
  crank.inertia = 7.4e-5 * n;
  for (int i = 0; i < n; ++i) {
    const double h = half_tangent(i, n), size = crank_length / (1 + h * h);
    Body& rod = scene.body[i + 1];
    rod.parent = 0;
    rod.at = {size * (1 - h * h), size * 2 * h};
    rod.mass = 0.038;
    rod.com = {rod_length / 2, 0};
    rod.inertia = 5.9e-4;
    Guide& way = scene.guide[i];
    way.slider = i + 1;
    way.contact[0] = {rod_length, 0};
    way.mu = way.mu_static = growth_mu;
  }
  if (!driven) return scene;
  scene.drives = 1;
  scene.drive[0].c[0] = crank_start;
  scene.drive[0].c[1] = crank_rate;
  return scene;
}

/// Puts the sliders of a star on the way.
template <int n>
void place_star(GrowthState<n>& state) {
  state.q[0] = crank_start;
  state.v[0] = crank_rate;
  for (int i = 0; i < n; ++i) {
    const double throw_angle = crank_start + 2 * std::atan(half_tangent(i, n));
    const double rod_angle = -std::asin(crank_length * std::sin(throw_angle) / rod_length);
    const double rod_rate = -crank_rate * crank_length * std::cos(throw_angle) / (rod_length * std::cos(rod_angle));
    state.q[i + 1] = rod_angle - crank_start;
    state.v[i + 1] = rod_rate - crank_rate;
  }
}

template <int n>
constexpr GrowthScene<n> levers() {
  GrowthScene<n> scene;
  scene.bodies = n + 1;
  scene.guides = n;
  scene.drives = 1;
  scene.gravity = {0, -9.81};
  for (int i = 0; i <= n; ++i) {
    Body& lever = scene.body[i];
    lever.at = {lever_distance * i, 0};
    lever.mass = 1;
    lever.com = {0.1, 0};
    lever.inertia = 0.02;
  }
  for (int i = 0; i < n; ++i) {
    Guide& slot = scene.guide[i];
    slot.slider = i;
    slot.rail = i + 1;
    slot.contact[0] = {lever_length, 0};
    slot.mu = slot.mu_static = growth_mu;
  }
  Drive& motor = scene.drive[0];
  motor.law = Law::harmonic;
  motor.terms = 4;
  motor.c[0] = rocked_from;
  motor.c[1] = rocked_by;
  motor.c[2] = rocked_at;
  return scene;
}

/// Puts the end of each lever in the slot of the next: tan(b) = -L sin(a) / (d - L cos(a)).
template <int n>
void place_levers(GrowthState<n>& state) {
  constexpr double L = lever_length, d = lever_distance;
  state.q[0] = rocked_from;
  state.v[0] = rocked_by * rocked_at;
  for (int i = 0; i < n; ++i) {
    const double a = state.q[i], c = std::cos(a);
    state.q[i + 1] = -std::atan2(L * std::sin(a), d - L * c);
    state.v[i + 1] = -state.v[i] * L * (d * c - L) / (d * d - 2 * d * L * c + L * L);
  }
}

/// A stepper as a case. It and the state are kept where the run finds them: the largest do not fit on a stack.
template <class Source, class Place>
GrowthCase growth_case(const std::string& family, int sliders, std::shared_ptr<const BasicStepper<Source>> stepper,
                       Place place) {
  using Size = typename Source::Size;
  const auto& tables = stepper->source.tables;
  GrowthCase one{family, sliders, 0, tables.most_rows, {}, {}};
  for (int part = 0; part < tables.parts; ++part) one.parts += tables.first_row[part] != tables.first_row[part + 1];
  auto start = std::make_shared<State<Size>>(stepper->start());
  place(*start);
  const auto state = std::make_shared<State<Size>>(*start);
  one.run = [stepper, start, state] {
    *state = *start;
    int solves = 0;
    for (int k = 0; k < growth_steps; ++k) {
      const Report report = stepper->step(*state, growth_dt);
      if (report.status != Status::ok) return 0;
      solves = report.solves > solves ? report.solves : solves;
    }
    return solves;
  };
  const std::size_t stack = stack_of([&] {
    *state = *start;
    stepper->step(*state, growth_dt);
  });
  one.bytes = {sizeof(Scene<Size>), sizeof(Tables<Size>), sizeof(State<Size>), stack};
  return one;
}

/// Largest star that is given to the compiler as well: beyond, it takes minutes.
inline constexpr int most_known_sliders = 16;

template <int n>
inline constexpr GrowthScene<n> known_star = star<n>(true);

template <int n>
void add_growth(std::vector<GrowthCase>& cases) {
  using RunTimeSource = RunTime<GrowthSize<n>>;
  const auto add = [&](const std::string& family, const GrowthScene<n>& scene, auto place) {
    cases.push_back(
        growth_case<RunTimeSource>(family, n, std::make_shared<const BasicStepper<RunTimeSource>>(scene), place));
  };
  add("driven crank", star<n>(true), place_star<n>);
  add("undriven crank", star<n>(false), place_star<n>);
  add("levers in a row", levers<n>(), place_levers<n>);
  if constexpr (n <= most_known_sliders) {
    using Known = CompileTime<known_star<n>>;
    cases.push_back(growth_case<Known>("driven crank, compile time", n, std::make_shared<const BasicStepper<Known>>(),
                                       place_star<n>));
  }
}

}  // namespace slideway::charts
