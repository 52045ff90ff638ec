#include "kernel_run.hpp"

#include <algorithm>

#include "recorder.hpp"

namespace slideway::app {
namespace {

/// Beside what the recorder saw: the state, accelerations and uniqueness.
bool keep(const Preparation& prepared, const Recorder& recorder, const RunState& state, KernelRun& run) {
  Reaction<io::RunSize> r;
  const Report report = prepared.stepper->reaction(state, prepared.inputs, r);
  if (report.status != Status::ok) return false;
  run.states.push_back(state);
  run.samples.push_back(recorder.sample());
  run.accelerations.emplace_back(r.acceleration, r.acceleration + coordinates(run.recording.file.scene));
  run.uniqueness.push_back(report.uniqueness);
  return true;
}

}  // namespace

KernelRun run_kernel(const Preparation& prepared, int divisor, Progress& progress) {
  KernelRun run;
  run.recording = prepared.recording;
  const Plan& plan = prepared.plan;
  const long long all = plan.steps * divisor;
  const long long stride = (plan.steps + most_verified_samples - 1) / most_verified_samples;
  Output no_csv("");
  Recorder recorder(*prepared.stepper, prepared.inputs, all, all + 1, no_csv, run.recording);
  RunState state = prepared.start;
  bool going = recorder.start(state) && keep(prepared, recorder, state, run);
  for (long long step = 0; step < plan.steps && going; ++step) {
    for (int part = 0; part < divisor && going; ++part) {
      const Report report = prepared.stepper->step(state, plan.of(step) / divisor, prepared.inputs);
      if (report.status != Status::ok) {
        recorder.refuse(report);
        return run;
      }
      going = recorder.step(state, report);
    }
    progress.show(static_cast<double>(step) / static_cast<double>(plan.steps), "of the kernel's steps");
    if (going && ((step + 1) % stride == 0 || step + 1 == plan.steps)) going = keep(prepared, recorder, state, run);
  }
  recorder.finish();
  return run;
}

}  // namespace slideway::app
