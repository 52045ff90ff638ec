#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <slideway/oracle/check.hpp>
#include <slideway/properties/step.hpp>

namespace slideway::properties {
namespace {

using oracle::Real;
using oracle::Verdict;

constexpr double thousands_of_roundings = 0x1p-40;

double energy(const RunStepper& stepper, const RunState& state) {
  return stepper.kinetic_energy(state) + stepper.potential_energy(state);
}

/// Of loads, and of what holds the drift, on what rounding moves in a step: 2^-40 of the motion, of the length at the
/// rate of the gains, and of their sum's own rounding, J.
double work_of_rounding(const RunStepper& stepper, const RunState& state, double dt) {
  const auto& scene = stepper.source.scene;
  const double length = stepper.source.tables.length;
  const double alpha = std::fabs(stepper.gains.alpha), beta = std::fabs(stepper.gains.beta);
  double mass = 0;
  for (int i = 0; i < scene.bodies; ++i) mass += scene.body[i].mass;
  const double speed = std::sqrt(2 * stepper.kinetic_energy(state) / mass);
  const double force = typical_force(scene) + mass * (beta * length + alpha * speed);
  const double moved = dt * (speed + (alpha + std::sqrt(beta)) * length) + thousands_of_roundings * length;
  return thousands_of_roundings * force * moved;
}

/// By n steps of dt / n from a state, J; NaN where one is refused.
double dissipated_in_parts(const RunStepper& stepper, RunState state, double dt, int n,
                           const RunStepper::Inputs& inputs) {
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const Report report = stepper.step(state, dt / n, inputs);
    sum += report.status == Status::ok ? report.energy.dissipated : std::numeric_limits<double>::quiet_NaN();
  }
  return sum;
}

oracle::ClaimedInstant claim_of(const RunStepper& stepper, const RunState& state, const RunStepper::Reaction& r) {
  const auto& table = stepper.source.tables;
  const auto& scene = stepper.source.scene;
  oracle::ClaimedInstant c;
  c.t = state.time();
  c.q.assign(state.q, state.q + table.coordinates);
  c.v.assign(state.v, state.v + table.coordinates);
  c.acceleration.assign(r.acceleration, r.acceleration + table.coordinates);
  c.lambda.assign(r.lambda, r.lambda + table.contacts);
  c.friction.assign(r.friction, r.friction + scene.guides);
  c.drive.assign(r.drive, r.drive + scene.drives);
  for (int p = 0; p < scene.pins; ++p) c.pin.insert(c.pin.end(), {r.pin[p].x, r.pin[p].y});
  c.mode.assign(state.mode, state.mode + scene.guides);
  c.energy = energy(stepper, state);
  return c;
}

/// Rounding of what is near zero is that of the terms that cancel there, `terms`. Forces far beyond these come from a
/// matrix that is nearly singular, and its entries' rounding grows by as much again.
bool fits(const oracle::Shortfall& s, double terms) {
  const double size = std::fmax(s.scale, terms);
  constexpr double patterns = 4;  // the bound is from two patterns of signs: others have exceeded it, by less than this
  return s.error <= patterns * s.bound || s.error <= 1e-13 * size * std::fmax(10, s.scale / terms);
}

}  // namespace

double typical_force(const Scene<io::RunSize>& scene) {
  double most = 0;
  for (int l = 0; l < scene.loads; ++l)
    most = std::fmax(most, std::hypot(scene.load[l].force.x, scene.load[l].force.y));
  for (int i = 0; i < scene.bodies; ++i) {
    most = std::fmax(most, scene.body[i].mass * std::hypot(scene.gravity.x, scene.gravity.y));
  }
  return most + 1e-3;
}

Violation coulomb(const RunStepper& stepper, const RunState& state) {
  RunStepper::Reaction r;
  if (stepper.reaction(state, {}, r).status != Status::ok) return {};
  const auto& scene = stepper.source.scene;
  double largest = typical_force(scene);
  for (int c = 0; c < stepper.source.tables.contacts; ++c) largest = std::fmax(largest, std::fabs(r.lambda[c]));
  for (int g = 0; g < scene.guides; ++g) largest = std::fmax(largest, std::fabs(r.friction[g]));
  const double slack = 2 * thousands_of_roundings * largest;
  for (int g = 0; g < scene.guides; ++g) {
    const Guide& guide = scene.guide[g];
    double normal = 0;
    for (int c = 0; c < guide.contacts; ++c) {
      normal += std::fabs(r.lambda[stepper.source.tables.first_contact[g] + c]);
    }
    const double v = r.slip[g], dry = r.friction[g] + guide.viscous * v;
    const double most = guide.mu_static * normal + guide.preload, kinetic = guide.mu * normal + guide.preload;
    if (!(std::fabs(dry) <= most + slack)) {
      return fmt::format("guide {}: |F| = {} N is beyond mu_static Lambda + preload = {} N", g, std::fabs(dry), most);
    }
    const bool rough = guide.mu_static > 0 || guide.preload > 0;
    const bool slips = rough && state.decided && state.mode[g] != 0 && std::fabs(v) > 1e-9;
    if (slips && !(std::fabs(dry + (v > 0 ? kinetic : -kinetic)) <= slack)) {
      return fmt::format("guide {}: slips by {} m/s, F = {} N is not -+{} N", g, v, dry, kinetic);
    }
    if (slips && r.friction[g] * v > 0)
      return fmt::format("guide {}: F = {} N drives the slip {} m/s", g, r.friction[g], v);
  }
  return {};
}

Violation step_contract(const RunStepper& stepper, const RunState& before, const RunState& after, const Report& report,
                        double dt, const RunStepper::Inputs& inputs) {
  if (report.status != Status::ok) {
    return std::memcmp(&before, &after, sizeof before) == 0 ? Violation{} : "a refused step has changed the state";
  }
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
    if (!std::isfinite(after.q[j]) || !std::isfinite(after.v[j])) return fmt::format("coordinate {} is not finite", j);
  }
  const bool counts_on = before.dt == dt;
  if (after.dt != dt || !after.decided || after.steps != (counts_on ? before.steps + 1 : 1) ||
      after.start != (counts_on ? before.start : before.time())) {
    return "the state's time has not advanced by a step";
  }
  const EnergyFlow& e = report.energy;
  if (!std::isfinite(e.work) || !std::isfinite(e.dissipated) || !std::isfinite(e.constraint_work)) {
    return "a flow of energy is not finite";
  }
  const double crossed = std::fabs(e.work) + std::fabs(e.constraint_work) + stepper.kinetic_energy(before) +
                         stepper.kinetic_energy(after) +
                         std::fabs(stepper.potential_energy(after) - stepper.potential_energy(before));
  const double given = -e.dissipated - thousands_of_roundings * crossed - work_of_rounding(stepper, before, dt);
  if (!(given > 0)) return {};
  if (stepper.method == Method::rk4_located || stepper.method == Method::dop853_located) {
    const double rate = std::fabs(stepper.gains.alpha) + std::sqrt(std::fabs(stepper.gains.beta));
    for (const int parts : {16, 128, 1024}) {
      const double better = dissipated_in_parts(stepper, before, dt, parts, inputs);
      if (!(given > 2 * std::fabs(e.dissipated - better))) return {};
      if (dt / parts * rate <= 1) break;
    }
  }
  return fmt::format("friction and dampers gave {} J", -e.dissipated);
}

InstantJudgement judge_instant(const RunStepper& stepper, const RunState& at) {
  RunState state = at;
  RunStepper::Reaction r;
  const Report report = stepper.reaction(state, {}, r);
  if (report.status != Status::ok) return {};
  // To the oracle, a guide whose speed is zero is at rest, wherever it goes from there.
  for (int g = 0; g < stepper.source.scene.guides; ++g) {
    const bool held = state.decided && state.mode[g] == 0, still = std::fabs(r.slip[g]) <= 1e-14;
    state.mode[g] = static_cast<signed char>(held || still ? 0 : r.slip[g] > 0 ? 1 : -1);
  }
  const Vec2 g = stepper.source.scene.gravity;
  const double force = typical_force(stepper.source.scene), motion = std::hypot(g.x, g.y) + 1;
  oracle::Checker checker(oracle::model_of<Real>(stepper.source.scene));
  const oracle::InstantCheck check = checker.check(claim_of(stepper, state, r));
  const bool claimed_unique = report.uniqueness == Uniqueness::certified || report.uniqueness == Uniqueness::single;
  const bool motion_fits = fits(check.acceleration, motion);
  const bool forces_fit =
      fits(check.lambda, force) && fits(check.friction, force) && fits(check.drive, force) && fits(check.pin, force);
  const bool good = check.verdict == Verdict::several       ? report.uniqueness == Uniqueness::refuted
                    : check.verdict == Verdict::motion_only ? !claimed_unique && motion_fits
                    : check.verdict == Verdict::unique      ? check.answered && motion_fits && forces_fit
                                                            : check.verdict != Verdict::none;
  if (good) return {true, {}};
  const auto shortfall = [](const char* what, const oracle::Shortfall& s) {
    return fmt::format(", {} off by {:.3g}, bound {:.3g}", what, s.error, s.bound);
  };
  return {true, fmt::format("oracle's verdict {}, kernel's uniqueness {}", static_cast<int>(check.verdict),
                            name(report.uniqueness)) +
                    shortfall("accelerations", check.acceleration) + shortfall("contact forces", check.lambda) +
                    shortfall("friction", check.friction) + shortfall("drives", check.drive) +
                    shortfall("pins", check.pin)};
}

}  // namespace slideway::properties
