// slideway run: steps a scene and writes what happened.
#include <chrono>
#include <memory>

#include "messages.hpp"
#include "preparation.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "report.hpp"
#include "run_document.hpp"
#include "run_options.hpp"
#include "run_table.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

/// Makes the planned steps in blocks: the clock is read around a block of steps alone, reactions and records come
/// after it. Returns nanoseconds a step, over the steps that were made.
double advance(const Preparation& prepared, Recorder& recorder, Progress& progress) {
  const Plan& plan = prepared.plan;
  constexpr std::size_t block = 64;
  std::vector<RunState> states(block + 1, prepared.start);
  std::vector<Report> reports(block);
  std::chrono::duration<double, std::nano> spent{};
  long long timed = 0;
  for (long long done = 0; done < plan.steps;) {
    const auto count = static_cast<std::size_t>(std::min<long long>(block, plan.steps - done));
    std::size_t made = 0;
    const auto before = std::chrono::steady_clock::now();
    for (; made < count; ++made) {
      states[made + 1] = states[made];
      reports[made] =
          prepared.stepper->step(states[made + 1], plan.of(done + static_cast<long long>(made)), prepared.inputs);
      if (reports[made].status != Status::ok) break;
    }
    spent += std::chrono::steady_clock::now() - before;
    timed += static_cast<long long>(made < count ? made + 1 : made);
    bool going = true;
    for (std::size_t i = 0; i < made && going; ++i, ++done) going = recorder.step(states[i + 1], reports[i]);
    if (going && made < count) recorder.refuse(reports[made]);
    if (!going || made < count) break;
    states[0] = states[count];
    progress.show(static_cast<double>(done) / static_cast<double>(plan.steps), "of the steps");
  }
  return spent.count() / static_cast<double>(timed);
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
  int status = good;
  auto prepared = prepare(options, status);
  if (!prepared) return status;
  Recording& recording = prepared->recording;
  Outputs outputs(options);
  if (!outputs.open(options.scene.scene)) return bad_input;

  Recorder recorder(*prepared->stepper, prepared->inputs, prepared->plan.steps, options.every, outputs.csv, recording);
  if (recorder.start(prepared->start)) {
    Progress progress(options.quiet);
    recording.ns_per_step = advance(*prepared, recorder, progress);
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
