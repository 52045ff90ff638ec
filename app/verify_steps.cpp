// Steps of the kernel beside the same steps in exact arithmetic, and the run's drift beside its bound.
#include <algorithm>
#include <cmath>
#include <slideway/oracle/drift.hpp>

#include "verify_model.hpp"

namespace slideway::app {
namespace {

using oracle::Real;

constexpr std::size_t most_steps = 32;  ///< that are made in exact arithmetic
constexpr int most_defects = 100;       ///< at which the method's defect is sampled

oracle::TreeState<Real> tree_state(double t, const double* q, const double* v, int n) {
  return {Real(t), {q, q + n}, {v, v + n}};
}

double distance(const std::vector<Real>& exact, const double* x, double& scale) {
  double most = 0;
  for (std::size_t j = 0; j < exact.size(); ++j) {
    most = oracle::worse(most, std::fabs(static_cast<double>(exact[j] - Real(x[j]))));
    scale = std::max(scale, std::fabs(x[j]));
  }
  return most;
}

/// A step may be off by the rounding of q and v, some ulps of the largest, and by what its accelerations are off by.
void check_exact_steps(const Preparation& prepared, const Verification& verification, oracle::Method<Real>& method,
                       oracle::Scheme scheme, CheckGroup& group, Progress& progress) {
  const KernelRun& run = verification.run;
  const int n = coordinates(prepared.recording.file.scene);
  const double h = prepared.recording.dt;
  const double acceleration = verification.acceleration_bound;
  Check q{"positions after a step", "m, rad"}, v{"speeds after a step", "m/s, rad/s"};
  std::size_t different = 0;
  const std::size_t stride = (run.states.size() + most_steps - 1) / most_steps;
  for (std::size_t i = 0; i < run.states.size(); i += stride) {
    RunState state = run.states[i];
    const double t = state.time();
    oracle::TreeState<Real> exact;
    const auto verdict = method.step(scheme, tree_state(t, state.q, state.v, n), Real(h), exact);
    const bool made = prepared.stepper->step(state, h, prepared.inputs).status == Status::ok;
    progress.show(static_cast<double>(i) / static_cast<double>(run.states.size()), "of the exact steps");
    if (made != oracle::Method<Real>::goes_on(verdict)) ++different;
    if (!made || !oracle::Method<Real>::goes_on(verdict)) continue;
    const auto worse = [&](Check& check, double error) {
      check.curve.push_back(error);
      if (error > check.error) check.t = t;
      check.error = oracle::worse(check.error, error);
    };
    worse(q, distance(exact.q, state.q, q.scale));
    worse(v, distance(exact.v, state.v, v.scale));
  }
  // The largest value's ulp, four roundings of q and v in a stage's sum; v moves q over h.
  v.bound = 4 * 0x1p-52 * v.scale + h * acceleration;
  q.bound = 4 * 0x1p-52 * q.scale + h * v.bound;
  if (q.scale > 0) group.checks.push_back(q);
  if (v.scale > 0) group.checks.push_back(v);
  Check refused{"steps", "that only one of both makes"};
  refused.error = static_cast<double>(different);
  group.checks.push_back(refused);
}

void check_drift(const Preparation& prepared, Verification& verification, const oracle::Model<Real>& model,
                 oracle::Method<Real>& method, oracle::Scheme scheme, CheckGroup& group, Progress& progress) {
  const KernelRun& run = verification.run;
  const Real h(prepared.recording.dt), duration(run.samples.back().t);
  oracle::TrajectoryOptions options;
  options.progress = [&](double t) { progress.show(t / static_cast<double>(duration), "of the drift bound"); };
  oracle::Integrator<Real> integrator(model, options);
  const auto events = integrator.run(duration, {}).events;
  const auto times = oracle::sample_times(events, h, duration, most_defects);
  std::vector<oracle::TreeState<Real>> states;
  for (const auto& sample : integrator.run(duration, times).samples) states.push_back({sample.t, sample.q, sample.v});
  const auto start = tree_state(0, prepared.start.q, prepared.start.v, static_cast<int>(model.start.q.size()));
  const auto bound = oracle::drift_bound(method, scheme, h, static_cast<long>(run.recording.steps), start, states);
  if (!bound) {
    verification.not_checked.push_back("Drift: the method has no step in exact arithmetic from some state.");
    return;
  }
  Check position{"drift", "m, rad"}, velocity{"drift of rates", "m/s, rad/s"};
  position.error = run.recording.drift_position;
  velocity.error = run.recording.drift_velocity;
  position.bound = static_cast<double>(bound->bound.position);
  velocity.bound = static_cast<double>(bound->bound.velocity);
  position.scale = prepared.stepper->source.tables.length;
  position.bound_grows = velocity.bound_grows = true;
  for (const Sample& s : run.samples) {
    position.curve.push_back(s.drift);
    for (double v : s.v) velocity.scale = std::max(velocity.scale, std::fabs(v));
  }
  group.checks.push_back(position);
  if (velocity.scale > 0) group.checks.push_back(velocity);
}

}  // namespace

CheckGroup check_steps(const Preparation& prepared, Verification& verification, Progress& progress) {
  CheckGroup group{"Step by step", "single steps in exact arithmetic, and the drift against its a-priori bound", {}};
  if (prepared.stepper->method == Method::kinematic) {
    verification.not_checked.push_back("Steps and drift: the method solves for positions at each time, by themselves.");
    return group;
  }
  const auto scheme = prepared.stepper->method == Method::euler ? oracle::Scheme::euler : oracle::Scheme::rk4;
  const oracle::Model<Real> model = model_of(prepared);
  oracle::Dynamics<Real> dynamics(model, oracle::FrictionLaw<Real>::orders);
  oracle::FrictionLaw<Real> law(dynamics);
  oracle::Method<Real> method(dynamics, law);
  check_exact_steps(prepared, verification, method, scheme, group, progress);
  if (prepared.recording.file.scene.guides + prepared.recording.file.scene.pins + prepared.recording.file.scene.drives >
      0) {
    check_drift(prepared, verification, model, method, scheme, group, progress);
  }
  return group;
}

}  // namespace slideway::app
