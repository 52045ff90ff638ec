#include "trial.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace slideway::app {
namespace {

using Stepper = io::RunStepper;

std::unique_ptr<Stepper> stepper_of(const Scene<io::RunSize>& scene, Method method) {
  auto stepper = std::make_unique<Stepper>(scene);
  stepper->method = method;
  return stepper;
}

void append(std::vector<double>& list, Vec2 r) { list.insert(list.end(), {r.x, r.y}); }

/// False when the kernel refuses to give the forces.
bool look(const Stepper& stepper, const Stepper::State& state, Trial& trial) {
  Stepper::Reaction r;
  if (stepper.reaction(state, {}, r).status != Status::ok) return false;
  const auto& scene = stepper.source.scene;
  const auto& table = stepper.source.tables;
  Kinematics<io::RunSize> k;
  const double accelerations[io::RunSize::coordinates] = {};
  kinematics(stepper.source, state.q, state.v, accelerations, k);
  for (int i = 0; i < scene.bodies; ++i) {
    append(trial.places, k.origin[i] + k.turn[i] * scene.body[i].com);
    append(trial.turns, {k.turn[i].c, k.turn[i].s});
  }
  for (int g = 0; g < scene.guides; ++g) {
    const int c = table.first_contact[g];
    const double other = scene.guide[g].contacts == 2 ? r.lambda[c + 1] : 0;
    append(trial.contacts, {r.lambda[c] + other, r.friction[g]});
  }
  trial.drives.insert(trial.drives.end(), r.drive, r.drive + scene.drives);
  return true;
}

double seconds_of(const Stepper& stepper, const TrialPlan& plan) {
  auto state = stepper.start();
  const auto start = std::chrono::steady_clock::now();
  constexpr int most = 200;  // steps
  for (int k = 0; k < std::min(most, plan.steps); ++k) stepper.step(state, plan.dt);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// max |a - b|, over both from the start as far as both go.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double apart = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) apart = std::fmax(apart, std::fabs(a[i] - b[i]));
  return apart;
}

double largest(const std::vector<double>& list) {
  double most = 0;
  for (const double x : list) most = std::fmax(most, std::fabs(x));
  return most;
}

double relative(const std::vector<double>& a, const std::vector<double>& b) {
  const double size = largest(a), difference = largest_difference(a, b);
  return difference > 0 ? difference / size : 0;
}

}  // namespace

Trial run_trial(const Scene<io::RunSize>& scene, const TrialPlan& plan) {
  const auto stepper = stepper_of(scene, plan.method);
  Trial trial;
  trial.length = stepper->source.tables.length;
  auto state = stepper->start();
  if (!look(*stepper, state, trial)) return trial;
  double kinetic = stepper->kinetic_energy(state), work = 0;
  double least = stepper->potential_energy(state), most = least;
  for (; trial.steps < plan.steps; ++trial.steps) {
    const Report report = stepper->step(state, plan.dt);
    if (report.status != Status::ok || !look(*stepper, state, trial)) break;
    trial.evaluations += report.evaluations;
    trial.drift = std::fmax(trial.drift, report.drift_position);
    trial.dissipated += report.energy.dissipated;
    work += report.energy.work;
    kinetic = std::fmax(kinetic, stepper->kinetic_energy(state));
    least = std::fmin(least, stepper->potential_energy(state));
    most = std::fmax(most, stepper->potential_energy(state));
  }
  trial.evaluations /= std::max(1, trial.steps);
  trial.in_play = kinetic + (most - least) + std::fabs(work);
  return trial;
}

double Apart::largest() const { return std::fmax(places, std::fmax(contacts, drives)); }

Apart apart(const Trial& one, const Trial& other, const std::vector<int>& without_turn) {
  Apart d;
  d.places = largest_difference(one.places, other.places) / one.length;
  const std::size_t looks = static_cast<std::size_t>(std::min(one.steps, other.steps) + 1);
  const std::size_t bodies = one.turns.size() / (2 * static_cast<std::size_t>(one.steps + 1));
  for (std::size_t k = 0; k < looks * bodies; ++k) {
    if (std::find(without_turn.begin(), without_turn.end(), static_cast<int>(k % bodies)) != without_turn.end())
      continue;
    for (const std::size_t i : {2 * k, 2 * k + 1})
      d.places = std::fmax(d.places, std::fabs(one.turns[i] - other.turns[i]));
  }
  d.contacts = relative(one.contacts, other.contacts);
  d.drives = relative(one.drives, other.drives);
  return d;
}

double time_ratio(const Scene<io::RunSize>& one, const TrialPlan& plan_of_one, const Scene<io::RunSize>& other,
                  const TrialPlan& plan_of_other) {
  constexpr int turns = 15;
  const auto a = stepper_of(one, plan_of_one.method), b = stepper_of(other, plan_of_other.method);
  double seconds_a = HUGE_VAL, seconds_b = HUGE_VAL;
  for (int k = 0; k < turns; ++k) {
    seconds_a = std::fmin(seconds_a, seconds_of(*a, plan_of_one));
    seconds_b = std::fmin(seconds_b, seconds_of(*b, plan_of_other));
  }
  return seconds_b / seconds_a;
}

}  // namespace slideway::app
