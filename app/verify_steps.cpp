// Steps of the kernel beside the same steps in exact arithmetic, and the run's drift beside its bound.
#include <algorithm>
#include <cmath>
#include <slideway/oracle/drift.hpp>

#include "verify_model.hpp"

namespace slideway::app {
namespace {

using oracle::Real;

constexpr std::size_t most_steps = 32;    ///< that are made in exact arithmetic, from states of the run
constexpr std::size_t most_crossed = 16;  ///< and from states just before events, which such steps seldom meet
constexpr int most_defects = 100;         ///< at which the method's defect is sampled

/// The scheme of a method that has one.
std::optional<oracle::Scheme> scheme_of(Method method) {
  for (const auto scheme :
       {oracle::Scheme::euler, oracle::Scheme::rk4, oracle::Scheme::rk4_located, oracle::Scheme::dop853_located}) {
    if (oracle::method_of(scheme) == method) return scheme;
  }
  return std::nullopt;
}

/// A state of the kernel, with the guides that it knows to be at rest.
oracle::TreeState<Real> tree_state(const RunStepper& stepper, const RunState& state) {
  const auto& table = stepper.source.tables;
  const int n = table.coordinates;
  oracle::TreeState<Real> same{Real(state.time()), {state.q, state.q + n}, {state.v, state.v + n}};
  for (int g = 0; g < stepper.source.scene.guides; ++g) {
    same.rests.push_back(table.is_rough[g] && state.decided && state.mode[g] == 0);
  }
  return same;
}

double distance(const std::vector<Real>& exact, const double* x, double& scale) {
  double most = 0;
  for (std::size_t j = 0; j < exact.size(); ++j) {
    most = oracle::worse(most, std::fabs(static_cast<double>(exact[j] - Real(x[j]))));
    scale = std::max(scale, std::fabs(x[j]));
  }
  return most;
}

/// The run's state before the step that ends at t, or the one nearest after it that is kept.
RunState before_step_to(double t, const Preparation& prepared, const KernelRun& run) {
  const double h = prepared.recording.dt;
  const auto later = [&](const RunState& s) { return s.time() > t - h / 2; };
  const auto found = std::find_if(run.states.begin(), run.states.end(), later);
  RunState state = found == run.states.begin() ? *found : *(found - 1);
  while (state.time() + 1.5 * h < t && prepared.stepper->step(state, h, prepared.inputs).status == Status::ok) continue;
  return state;
}

/// Where single steps are compared: samples of the run, and before the first steps in which a mode or contact sign
/// changed, of methods that go over them.
std::vector<RunState> states_to_step_from(const Preparation& prepared, const KernelRun& run) {
  std::vector<RunState> states;
  const std::size_t stride = (run.states.size() + most_steps - 1) / most_steps;
  for (std::size_t i = 0; i < run.states.size(); i += stride) states.push_back(run.states[i]);
  double last = 0;
  for (const Event& event : run.recording.events) {
    if (run.recording.located || states.size() >= most_steps + most_crossed) break;
    if (event.t > last) states.push_back(before_step_to(event.t, prepared, run));
    last = event.t;
  }
  return states;
}

/// Errors of single steps, and what was compared.
struct StepErrors {
  Check q{"positions after a step", "m, rad"}, v{"speeds after a step", "m/s, rad/s"};
  Check refused{"steps", "that only one of both makes"};
  std::size_t cut = 0;  ///< by events, so that they are not single steps of the method
  std::vector<oracle::TreeState<Real>> froms;

  static void take(Check& check, double error, double t) {
    check.curve.push_back(error);
    if (error > check.error) check.t = t;
    check.error = oracle::worse(check.error, error);
  }
};

void compare_step(const Preparation& prepared, oracle::Method<Real>& method, oracle::Scheme scheme, RunState state,
                  StepErrors& errors) {
  const double t = state.time(), h = prepared.recording.dt;
  errors.froms.push_back(tree_state(*prepared.stepper, state));
  const Report report = prepared.stepper->step(state, h, prepared.inputs);
  if (report.events > 0) {
    ++errors.cut;
    return;
  }
  oracle::TreeState<Real> exact;
  const bool made = report.status == Status::ok;
  const bool exists = oracle::Method<Real>::goes_on(method.step(scheme, errors.froms.back(), Real(h), exact));
  errors.refused.error += made != exists ? 1 : 0;
  if (!made || !exists) return;
  StepErrors::take(errors.q, distance(exact.q, state.q, errors.q.scale), t);
  StepErrors::take(errors.v, distance(exact.v, state.v, errors.v.scale), t);
}

/// A step may be off by the rounding of q and v, some ulps of the largest, and by what its accelerations are off by;
/// and by what the kernel's projection, if there is one, leaves.
void check_exact_steps(const Preparation& prepared, Verification& verification, oracle::Method<Real>& method,
                       oracle::Scheme scheme, CheckGroup& group, Progress& progress) {
  const double h = prepared.recording.dt;
  StepErrors errors;
  for (const RunState& state : states_to_step_from(prepared, verification.run)) {
    compare_step(prepared, method, scheme, state, errors);
    progress.show(static_cast<double>(errors.froms.size()) / (most_steps + most_crossed), "of the exact steps");
  }
  if (errors.cut > 0) {
    verification.not_checked.push_back(
        fmt::format("{} of {} steps: the kernel located events in them, and they are not single steps of the method.",
                    errors.cut, errors.froms.size()));
  }
  const auto left =
      method.projects ? oracle::projection_error(method, errors.froms) : oracle::Drift<Real>{Real(0), Real(0)};
  // The largest value's ulp, four roundings of q and v in a stage's sum; v moves q over h.
  const double weight = static_cast<double>(oracle::runge_kutta<Real>(scheme).weight());
  Check &q = errors.q, &v = errors.v;
  v.bound = 4 * 0x1p-52 * v.scale + h * weight * verification.acceleration_bound + static_cast<double>(left.velocity);
  q.bound = 4 * 0x1p-52 * q.scale + h * v.bound + static_cast<double>(left.position);
  for (const Check& check : {q, v}) {
    if (check.scale > 0 || !(check.error <= check.bound)) group.checks.push_back(check);
  }
  group.checks.push_back(errors.refused);
}

/// Events cut a step in two, and make a step more of it.
std::optional<oracle::Drift<Real>> drift_bound(oracle::Method<Real>& method, oracle::Scheme scheme, const Real& h,
                                               const Recording& recording, const oracle::TreeState<Real>& start,
                                               const std::vector<oracle::TreeState<Real>>& states) {
  if (method.projects) {
    const auto first = method.largest_drift(start), left = oracle::projected_drift(method, states);
    return oracle::Drift<Real>{Real(first.position + left.position), Real(first.velocity + left.velocity)};
  }
  const std::size_t cuts = recording.located ? recording.events.size() : 0;
  const auto found = oracle::drift_bound(method, scheme, h,
                                         static_cast<long>(recording.steps) + static_cast<long>(cuts), start, states);
  return found ? std::optional(found->bound) : std::nullopt;
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
  for (const auto& sample : integrator.run(duration, times).samples) {
    states.push_back({sample.t, sample.q, sample.v, {}});
    for (std::size_t g = 0; g < sample.mode.slip.size(); ++g) {
      states.back().rests.push_back(model.guide[g].rough() && sample.mode.slip[g] == 0);
    }
  }
  const auto start = tree_state(*prepared.stepper, prepared.start);
  const auto bound = drift_bound(method, scheme, h, run.recording, start, states);
  if (!bound) {
    verification.not_checked.push_back("Drift: the method has no step in exact arithmetic from some state.");
    return;
  }
  Check position{"drift", "m, rad"}, velocity{"drift of rates", "m/s, rad/s"};
  position.error = run.recording.drift_position;
  velocity.error = run.recording.drift_velocity;
  position.bound = static_cast<double>(bound->position);
  velocity.bound = static_cast<double>(bound->velocity);
  position.scale = prepared.stepper->source.tables.length;
  position.bound_grows = velocity.bound_grows = true;
  velocity.scale = position.scale / static_cast<double>(duration);  // where nothing moves faster
  velocity.bound = std::max(velocity.bound, 0x1p-52 * velocity.scale);
  for (const Sample& s : run.samples) {
    position.curve.push_back(s.drift);
    for (double v : s.v) velocity.scale = std::max(velocity.scale, std::fabs(v));
  }
  group.checks.push_back(position);
  group.checks.push_back(velocity);
}

}  // namespace

CheckGroup check_steps(const Preparation& prepared, Verification& verification, Progress& progress) {
  CheckGroup group{"Step by step", "single steps in exact arithmetic, and the drift against its a-priori bound", {}};
  const auto scheme = scheme_of(prepared.stepper->method);
  if (!scheme) {
    verification.not_checked.push_back(
        prepared.stepper->method == Method::kinematic
            ? "Steps and drift: the method solves for positions at each time, by themselves."
            : "Steps and drift: the oracle has no means of forces over a step.");
    return group;
  }
  const oracle::Model<Real> model = model_of(prepared);
  oracle::Dynamics<Real> dynamics(model, oracle::FrictionLaw<Real>::orders);
  oracle::FrictionLaw<Real> law(dynamics);
  oracle::Method<Real> method(dynamics, law);
  method.projects = prepared.stepper->stabilise == Stabilise::projection;
  check_exact_steps(prepared, verification, method, *scheme, group, progress);
  if (prepared.recording.file.scene.guides + prepared.recording.file.scene.pins + prepared.recording.file.scene.drives >
      0) {
    check_drift(prepared, verification, model, method, *scheme, group, progress);
  }
  return group;
}

}  // namespace slideway::app
