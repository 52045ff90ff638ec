#include "preparation.hpp"

#include <algorithm>
#include <cmath>

#include "messages.hpp"
#include "run_options.hpp"
#include "scene_source.hpp"

namespace slideway::app {
namespace {

/// What the kernel's data say about the options together: a method that does not apply.
bool applies(const RunStepper& stepper, const io::SceneFile& file) {
  if (stepper.method != Method::kinematic || fully_driven(stepper.source)) return true;
  const auto& table = stepper.source.tables;
  complain("{}: method kinematic needs a scene that its drives move fully: {} undriven coordinates, {} constraints",
           file.file, table.free, table.contacts + 2 * file.scene.pins);
  return false;
}

void set_up(RunStepper& stepper, const StepOptions& options, const std::string& method) {
  stepper.method =
      *std::find_if(std::begin(methods), std::end(methods), [&](const Method one) { return method == name(one); });
  stepper.theta = options.theta;
  stepper.stabilise = options.stabilise == "projection" ? Stabilise::projection : Stabilise::baumgarte;
  stepper.gains.alpha = options.alpha.value_or(stepper.gains.alpha);
  stepper.gains.beta = options.beta.value_or(stepper.gains.beta);
  stepper.hlcp.not_unique = options.not_unique == "continue" ? NotUnique::continue_along_signs : NotUnique::refuse;
}

/// The start, on the constraints if that was asked for; nothing, and said, when that fails.
std::optional<RunState> starting_state(const RunStepper& stepper, const RunInputs& inputs, const StepOptions& options) {
  RunState state = stepper.start();
  if (!options.project_start) return state;
  const Report report = stepper.project(state, inputs);
  if (report.status == Status::ok) return state;
  complain("{}: the start cannot be moved onto the constraints: {}", options.scene.scene, sentence(report.status));
  return std::nullopt;
}

}  // namespace

Plan::Plan(double duration, double step) : dt(step) {
  constexpr double rounding = 1e-9;  // of a step: far above that of duration / dt, far below what anyone would see
  const double quotient = duration / dt;
  steps = std::max(1LL, static_cast<long long>(std::ceil(quotient - rounding)));
  const double missing = duration - static_cast<double>(steps - 1) * dt;
  last_dt = std::fabs(missing - dt) <= rounding * dt * std::fmax(1, quotient * 1e-6) ? dt : missing;
}

std::optional<Preparation> prepare(const StepOptions& options, int& status) {
  status = bad_input;
  const auto file = load_scene(options.scene.scene, options.scene.settings,
                               options.project_start ? Start::projected : Start::checked);
  if (!file) return std::nullopt;
  const auto values = input_values(options, *file);
  if (!values) return std::nullopt;

  Recording recording;
  recording.file = *file;
  recording.method = options.method.value_or(file->run.method);
  recording.dt = options.dt.value_or(file->run.dt);
  recording.duration = options.duration.value_or(file->run.duration);
  recording.input_values = *values;
  if (!(recording.duration / recording.dt < 1e15)) {
    complain("{}: duration {:g} s with dt {:g} s is more steps than can be counted", file->file, recording.duration,
             recording.dt);
    return std::nullopt;
  }

  auto stepper = std::make_unique<RunStepper>(file->scene);
  set_up(*stepper, options, recording.method);
  recording.alpha = stepper->gains.alpha;
  recording.beta = stepper->gains.beta;
  recording.located = is_located(stepper->method);
  recording.stabilise = options.stabilise;
  recording.theta = options.theta;
  RunInputs inputs;
  for (std::size_t i = 0; i < values->size(); ++i) inputs.input[i].value = (*values)[i];
  if (!applies(*stepper, *file)) return std::nullopt;
  auto start = starting_state(*stepper, inputs, options);
  if (!start) {
    status = refused;
    return std::nullopt;
  }
  const Plan plan(recording.duration, recording.dt);
  start->dt = plan.dt;  // so that the forces at the start can be means of the first step, where a method has no others
  status = good;
  return Preparation{std::move(recording), std::move(stepper), inputs, *start, plan};
}

}  // namespace slideway::app
