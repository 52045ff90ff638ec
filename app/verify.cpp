// slideway verify: a run of the kernel beside the oracle.
#include <memory>

#include "messages.hpp"
#include "output.hpp"
#include "preparation.hpp"
#include "run_options.hpp"
#include "verbs.hpp"
#include "verification.hpp"
#include "verify_report.hpp"
#include "verify_table.hpp"

namespace slideway::app {
namespace {

struct VerifyOptions : StepOptions {
  std::optional<double> digits;
};

Verification verify(const Preparation& prepared, Progress& progress) {
  Verification v;
  v.run = run_kernel(prepared, 1, progress);
  if (v.run.samples.empty()) return v;
  v.groups.push_back(check_states(prepared, v, progress));
  v.groups.push_back(check_steps(prepared, v, progress));
  v.groups.push_back(check_motion(prepared, v, progress));
  return v;
}

int run(const VerifyOptions& options) {
  int status = good;
  const auto prepared = prepare(options, status);
  if (!prepared) return status;
  Output json(options.json), report(options.report);
  if (!open_all({&json, &report}, options.scene.scene)) return bad_input;
  Verification verification;
  {
    Progress progress(options.quiet);
    verification = verify(*prepared, progress);
  }
  if (options.digits) ask_for_digits(verification, *options.digits);
  json.write(json.wanted() ? io::text(verify_document(verification)) : "");
  bool complete = json.close();
  if (report.wanted()) write_verify_report(verification, report.stream());
  complete = report.close() && complete;
  if (!options.quiet) {
    fmt::print(json.standard() || report.standard() ? stderr : stdout, "{}", verify_table(verification));
  }
  if (verification.run.recording.status != Status::ok) complain(verification.run.recording.message);
  if (!complete) return bad_input;
  return verification.held() ? good : refused;
}

}  // namespace

void add_verify(CLI::App& command, int& status) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* verb =
      command.add_subcommand("verify", "Step a scene and compare with exact and multiprecision arithmetic");
  add_step_options(*verb, *options);
  verb->add_option("--digits", options->digits, "Decimal digits that every quantity must share with the oracle")
      ->check(CLI::Range(0.0, 16.0));
  verb->callback([options, &status] { status = run(*options); });
}

}  // namespace slideway::app
