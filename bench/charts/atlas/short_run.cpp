#include "short_run.hpp"

#include <algorithm>
#include <cmath>

namespace slideway::charts {

ShortRun short_run(const io::RunStepper& stepper, const io::RunStepper::State& from, double dt, long steps) {
  ShortRun run;
  run.state = from;
  while (run.steps < steps) {
    const Report report = stepper.step(run.state, dt);
    run.status = report.status;
    if (report.status != Status::ok) break;
    ++run.steps;
    run.events += report.events;
    run.unlocated += report.unlocated_events;
    run.drift = std::max(run.drift, report.drift_position);
    run.uniqueness = weaker(run.uniqueness, report.uniqueness);
    add(run.flow, 1, report.energy);
  }
  return run;
}

double distance(const io::RunStepper& stepper, const io::RunStepper::State& a, const io::RunStepper::State& b) {
  const auto& table = stepper.source.tables;
  double most = 0;
  for (int j = 0; j < table.coordinates; ++j) {
    const double lever = table.motion[j] == Motion::turn ? table.length : 1;
    most = std::max(most, lever * std::fabs(a.q[j] - b.q[j]));
  }
  return most;
}

bool keeps_its_promise(const io::RunStepper& stepper, const io::RunStepper::State& from, double dt,
                       const ShortRun& made) {
  io::RunStepper judge = stepper;
  judge.method = Method::dop853_located;
  const ShortRun truth = short_run(judge, from, dt / 8, 8 * made.steps);
  const ShortRun coarser = short_run(judge, from, dt / 4, 4 * made.steps);
  const ShortRun half = short_run(stepper, from, dt / 2, 2 * made.steps);
  const ShortRun third = short_run(stepper, from, dt / 3, 3 * made.steps);
  for (const ShortRun* run : {&truth, &coarser, &half, &third}) {
    if (run->status != Status::ok) return true;
  }
  const double change = std::max(distance(stepper, made.state, half.state), distance(stepper, made.state, third.state));
  const double length = stepper.source.tables.length;
  const double promise = 2 * change + 2 * distance(stepper, truth.state, coarser.state) + 1e-13 * length;
  return distance(stepper, made.state, truth.state) <= 10 * promise;
}

}  // namespace slideway::charts
