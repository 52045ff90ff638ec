// slideway run: steps a scene and writes what happened.
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "messages.hpp"
#include "recorder.hpp"
#include "report.hpp"
#include "run_document.hpp"
#include "run_options.hpp"
#include "run_table.hpp"
#include "scene_source.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

/// How a duration is cut into steps. The last one ends at the duration: it is shorter, unless what is missing or too
/// much is rounding of the quotient.
struct Plan {
  long long steps = 0;
  double dt = 0, last_dt = 0;

  Plan(double duration, double step) : dt(step) {
    constexpr double rounding = 1e-9;  // of a step: far above that of duration / dt, far below what anyone would see
    const double quotient = duration / dt;
    steps = std::max(1LL, static_cast<long long>(std::ceil(quotient - rounding)));
    const double missing = duration - static_cast<double>(steps - 1) * dt;
    last_dt = std::fabs(missing - dt) <= rounding * dt * std::fmax(1, quotient * 1e-6) ? dt : missing;
  }
  double of(long long step) const noexcept { return step == steps - 1 ? last_dt : dt; }
};

/// How far the run is, on a terminal only, a few times a second.
class Progress {
 public:
  explicit Progress(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) == 1) {}
  void show(long long done, long long all) {
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    fmt::print(stderr, "\r{:5.1f} % of {} steps ", 100.0 * static_cast<double>(done) / static_cast<double>(all), all);
    std::fflush(stderr);
    dirty_ = true;
  }
  ~Progress() {
    if (dirty_) fmt::print(stderr, "\r{:40}\r", "");
  }

 private:
  bool shown_, dirty_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Makes the planned steps in blocks: the clock is read around a block of steps alone, reactions and records come
/// after it. Returns nanoseconds a step, over the steps that were made.
double advance(const RunStepper& stepper, const RunInputs& inputs, const Plan& plan, RunState state, Recorder& recorder,
               Progress& progress) {
  constexpr std::size_t block = 64;
  std::vector<RunState> states(block + 1, state);
  std::vector<Report> reports(block);
  std::chrono::duration<double, std::nano> spent{};
  long long timed = 0;
  for (long long done = 0; done < plan.steps;) {
    const auto count = static_cast<std::size_t>(std::min<long long>(block, plan.steps - done));
    std::size_t made = 0;
    const auto before = std::chrono::steady_clock::now();
    for (; made < count; ++made) {
      states[made + 1] = states[made];
      reports[made] = stepper.step(states[made + 1], plan.of(done + static_cast<long long>(made)), inputs);
      if (reports[made].status != Status::ok) break;
    }
    spent += std::chrono::steady_clock::now() - before;
    timed += static_cast<long long>(made < count ? made + 1 : made);
    bool going = true;
    for (std::size_t i = 0; i < made && going; ++i, ++done) going = recorder.step(states[i + 1], reports[i]);
    if (going && made < count) recorder.refuse(reports[made]);
    if (!going || made < count) break;
    states[0] = states[count];
    progress.show(done, plan.steps);
  }
  return spent.count() / static_cast<double>(timed);
}

/// What the kernel's data say about the options together: a method that does not apply.
bool applies(const RunStepper& stepper, const io::SceneFile& file) {
  if (stepper.method != Method::kinematic || fully_driven(stepper.source)) return true;
  const auto& table = stepper.source.tables;
  complain("{}: method kinematic needs a scene that its drives move fully: {} undriven coordinates, {} constraints",
           file.file, table.free, table.contacts + 2 * file.scene.pins);
  return false;
}

void set_up(RunStepper& stepper, const RunOptions& options, const std::string& method) {
  stepper.method = method == "euler" ? Method::euler : method == "kinematic" ? Method::kinematic : Method::rk4;
  stepper.gains.alpha = options.alpha.value_or(stepper.gains.alpha);
  stepper.gains.beta = options.beta.value_or(stepper.gains.beta);
  stepper.hlcp.not_unique = options.not_unique == "continue" ? NotUnique::continue_along_signs : NotUnique::refuse;
}

/// The start, on the constraints if that was asked for; nothing, and said, when that fails.
std::optional<RunState> starting_state(const RunStepper& stepper, const RunInputs& inputs, const RunOptions& options) {
  RunState state = stepper.start();
  if (!options.project_start) return state;
  const Report report = stepper.project(state, inputs);
  if (report.status == Status::ok) return state;
  complain("{}: the start cannot be moved onto the constraints: {}", options.scene.scene, sentence(report.status));
  return std::nullopt;
}

struct Outputs {
  Output csv, json, report;
  explicit Outputs(const RunOptions& options) : csv(options.csv), json(options.json), report(options.report) {}
  bool open(const std::string& scene) { return open_all({&csv, &json, &report}, scene); }
  bool use_standard_output() const { return csv.standard() || json.standard() || report.standard(); }
  /// Completes every file, whether or not another one failed.
  bool finish(const Recording& recording) {
    json.write(json.wanted() ? io::text(run_document(recording)) : "");
    if (report.wanted()) write_report(recording, report.stream());
    bool good = csv.close();
    good = json.close() && good;
    return report.close() && good;
  }
};

int run(const RunOptions& options) {
  const auto file = load_scene(options.scene.scene, options.scene.settings,
                               options.project_start ? Start::projected : Start::checked);
  if (!file) return bad_input;
  const auto values = input_values(options, *file);
  if (!values) return bad_input;

  Recording recording;
  recording.file = *file;
  recording.method = options.method.value_or(file->run.method);
  recording.dt = options.dt.value_or(file->run.dt);
  recording.duration = options.duration.value_or(file->run.duration);
  recording.input_values = *values;
  if (!(recording.duration / recording.dt < 1e15)) {
    complain("{}: duration {:g} s with dt {:g} s is more steps than can be counted", file->file, recording.duration,
             recording.dt);
    return bad_input;
  }

  const auto stepper = std::make_unique<RunStepper>(file->scene);
  set_up(*stepper, options, recording.method);
  recording.alpha = stepper->gains.alpha;
  recording.beta = stepper->gains.beta;
  RunInputs inputs;
  for (std::size_t i = 0; i < values->size(); ++i) inputs.input[i].value = (*values)[i];

  Outputs outputs(options);
  if (!applies(*stepper, *file)) return bad_input;
  const auto state = starting_state(*stepper, inputs, options);
  if (!state) return refused;
  if (!outputs.open(options.scene.scene)) return bad_input;

  const Plan plan(recording.duration, recording.dt);
  Recorder recorder(*stepper, inputs, plan.steps, options.every, outputs.csv, recording);
  if (recorder.start(*state)) {
    Progress progress(options.quiet);
    recording.ns_per_step = advance(*stepper, inputs, plan, *state, recorder, progress);
  }
  recorder.finish();

  const bool complete = outputs.finish(recording);
  if (!options.quiet) {
    fmt::print(outputs.use_standard_output() ? stderr : stdout, "{}",
               run_table(recording, {&outputs.csv, &outputs.json, &outputs.report}));
  }
  if (recording.status != Status::ok) complain(recording.message);
  if (!complete) return bad_input;
  return recording.status == Status::ok ? good : refused;
}

}  // namespace

void add_run(CLI::App& command, int& status) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* verb = command.add_subcommand("run", "Step a scene, print a summary, write trajectories and a report");
  add_run_options(*verb, *options);
  verb->callback([options, &status] { status = run(*options); });
}

}  // namespace slideway::app
