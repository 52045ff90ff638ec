#include "support/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "support/fail.hpp"

namespace slideway::fuzz {
namespace {

using properties::Choices;

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

void require(bool good, const RunStepper& stepper, const std::string& what) {
  if (!good) fail(fmt::format("{}: {}", name(stepper.method), what));
}

/// Copied with its padding, which a refusal leaves too.
RunState bytes_of(const RunState& state) {
  RunState copy;
  std::memcpy(&copy, &state, sizeof state);
  return copy;
}

bool finite(const double* x, int n) {
  return std::all_of(x, x + n, [](double value) { return std::isfinite(value); });
}

bool finite(const EnergyFlow& e) {
  return std::isfinite(e.work) && std::isfinite(e.dissipated) && std::isfinite(e.constraint_work);
}

void hold_report(const RunStepper& stepper, const Report& report) {
  const int guides = stepper.source.scene.guides;
  require(report.guide >= none && report.guide < guides, stepper, fmt::format("a report of guide {}", report.guide));
  if (report.status != Status::ok) return;
  require(
      std::isfinite(report.residual) && std::isfinite(report.drift_position) && std::isfinite(report.drift_velocity),
      stepper, "a report with ok has a number that is not finite");
}

void hold_events(const RunStepper& stepper, const Report& report, double from, double to) {
  require(report.events >= 0 && report.events <= std::max(0, stepper.max_events), stepper,
          fmt::format("{} events", report.events));
  for (int e = 0; e < report.events; ++e) {
    const Event& event = report.event[e];
    require(event.guide >= 0 && event.guide < stepper.source.scene.guides && event.contact >= none &&
                event.contact < stepper.source.scene.guide[event.guide].contacts,
            stepper, fmt::format("an event of guide {}, contact {}", event.guide, event.contact));
    const double before = e == 0 ? from : report.event[e - 1].t;
    require(event.t >= before && event.t <= to, stepper,
            fmt::format("event {} at {} s is not between {} s and {} s", e, event.t, before, to));
  }
}

}  // namespace

Report step(const RunStepper& stepper, RunState& state, double dt, const RunInputs& inputs) {
  const RunState before = bytes_of(state);
  const Report report = stepper.step(state, dt, inputs);
  const properties::Violation violation = properties::step_contract(stepper, before, state, report, dt, inputs);
  require(violation.empty(), stepper, violation);
  hold_report(stepper, report);
  if (report.status != Status::ok) return report;
  hold_events(stepper, report, before.time(), state.time());
  return report;
}

Report reaction(const RunStepper& stepper, const RunState& state, const RunInputs& inputs) {
  RunStepper::Reaction r;
  const Report report = stepper.reaction(state, inputs, r);
  hold_report(stepper, report);
  if (report.status != Status::ok) return report;
  const auto& scene = stepper.source.scene;
  bool all = std::isfinite(r.t) && finite(r.lambda, stepper.source.tables.contacts) &&
             finite(r.friction, scene.guides) && finite(r.slip, scene.guides) && finite(r.drive, scene.drives) &&
             finite(r.acceleration, stepper.source.tables.coordinates) && finite(r.power) &&
             std::isfinite(r.drift_position) && std::isfinite(r.drift_velocity);
  for (int p = 0; p < scene.pins; ++p) all = all && std::isfinite(r.pin[p].x) && std::isfinite(r.pin[p].y);
  require(all, stepper, "a reaction with ok has a number that is not finite");
  return report;
}

Report project(const RunStepper& stepper, RunState& state, const RunInputs& inputs) {
  RunState before = bytes_of(state);
  const Report report = stepper.project(state, inputs);
  const int n = stepper.source.tables.coordinates;
  if (report.status == Status::ok) {
    require(finite(state.q, n) && finite(state.v, n), stepper, "a projection is not finite");
    std::copy_n(state.q, n, before.q);
    std::copy_n(state.v, n, before.v);
  }
  require(std::memcmp(&before, &state, sizeof state) == 0, stepper,
          fmt::format("a projection ({}) has changed what it may not", name(report.status)));
  const bool far = std::any_of(state.q, state.q + n, [](double q) { return !(std::fabs(q) < 1e6); });
  if (report.status != Status::ok || far) return report;
  RunStepper strict = stepper;
  strict.method = Method::rk4;
  strict.drift_limit = 1e-6;
  RunStepper::Reaction r;
  require(strict.reaction(state, inputs, r).status != Status::drift_limit, stepper,
          fmt::format("a projection has left {} m", r.drift_position));
  return report;
}

void hold_coulomb(const RunStepper& stepper, const RunState& state) {
  RunStepper instant = stepper;
  instant.method = Method::rk4_located;  // moreau's forces are means over a step, of other slips
  const properties::Violation violation = properties::coulomb(instant, state);
  require(violation.empty(), stepper, violation);
}

Method draw_method(Choices& choices) { return methods[choices.below(static_cast<int>(std::size(methods)))]; }

double draw_dt(Choices& choices) {
  constexpr double others[] = {1e-2, 0.1, 1, 1e-300, 0, -1e-3, infinity, nan};
  switch (choices.below(8)) {
    case 5: {
      const double part = choices.positive(0);  // not beside the next: arguments have no order
      return std::ldexp(part, -choices.below(32));
    }
    case 6:
      return others[choices.below(8)];
    case 7:
      return choices.any_double();
    default:
      return 1e-3;
  }
}

void draw_options(Choices& choices, RunStepper& stepper) {
  constexpr int most_events[] = {32, 32, 32, 1, 0, 2, 33, -1};
  constexpr double thetas[] = {0.5, 0.5, 1, 0, 0.75, -0.5, 1.5, nan}, limits[] = {1e-3, 1e-3, 1, 0, infinity, nan};
  constexpr int most_solves[] = {64, 1, 2, 256};
  stepper.max_events = most_events[choices.below(8)];
  stepper.theta = thetas[choices.below(8)];
  stepper.drift_limit = limits[choices.below(6)];
  stepper.hlcp.max_solves = most_solves[choices.below(4)];
  if (choices.flag()) stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  if (choices.flag()) stepper.stabilise = Stabilise::projection;
  if (choices.below(8) == 1) stepper.gains.alpha = choices.any_double();
  if (choices.below(8) == 1) stepper.gains.beta = choices.any_double();
}

void disturb(Choices& choices, const RunStepper& stepper, RunState& state) {
  const int n = stepper.source.tables.coordinates;
  if (n == 0) return;
  double& x = (choices.flag() ? state.v : state.q)[choices.below(n)];
  switch (choices.below(4)) {
    case 0: {
      const double part = choices.dyadic(0);
      x += std::ldexp(part, -choices.below(60));
      break;
    }
    case 1:
      x = 0;
      break;
    case 2:
      x = std::nextafter(x, choices.flag() ? infinity : -infinity);
      break;
    default:
      x = choices.any_double();
  }
}

}  // namespace slideway::fuzz
