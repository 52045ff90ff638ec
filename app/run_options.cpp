#include "run_options.hpp"

#include <algorithm>
#include <cmath>
#include <slideway/io/text.hpp>

#include "messages.hpp"

namespace slideway::app {
namespace {

std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

CLI::Validator positive() {
  return {[](std::string& text) {
            const auto value = finite_number(text);
            return value && *value > 0 ? std::string() : "must be a number above zero, not " + io::quote(text);
          },
          "SECONDS"};
}

CLI::Validator not_negative() {
  return {[](std::string& text) {
            const auto value = finite_number(text);
            return value && *value >= 0 ? std::string() : "must be a number, zero or above, not " + io::quote(text);
          },
          "NUMBER"};
}

CLI::Validator from_zero_to_one() {
  return {[](std::string& text) {
            const auto value = finite_number(text);
            return value && *value >= 0 && *value <= 1 ? std::string()
                                                       : "must be a number from 0 to 1, not " + io::quote(text);
          },
          "NUMBER"};
}

CLI::Validator one_of(std::vector<std::string> choices) {
  return {[choices](std::string& text) {
            if (std::find(choices.begin(), choices.end(), text) != choices.end()) return std::string();
            return io::quote(text) + " is not there; there are: " + fmt::format("{}", fmt::join(choices, ", "));
          },
          fmt::format("{}", fmt::join(choices, "|"))};
}

}  // namespace

void add_step_options(CLI::App& verb, StepOptions& options) {
  add_scene_options(verb, options.scene);
  verb.add_option("--method", options.method, "How to step")->check(one_of(io::methods()));
  verb.add_option("--dt", options.dt, "Step, s")->check(positive());
  verb.add_option("--duration", options.duration, "Of the run, s")->check(positive());
  verb.add_option("--alpha", options.alpha, "Baumgarte's gain on rates, 1/s")->check(not_negative());
  verb.add_option("--beta", options.beta, "Baumgarte's gain on positions, 1/s^2")->check(not_negative());
  verb.add_option("--json", options.json, "Write the summary as JSON; - is standard output");
  verb.add_option("--report", options.report, "Write an HTML page with charts");
  verb.add_flag("--project-start", options.project_start, "Move the start onto the constraints");
  verb.add_option("--input", options.inputs, "NAME=V: a live input, constant over the run")->allow_extra_args(false);
  verb.add_option("--not-unique", options.not_unique, "When several sets of contact forces are possible")
      ->check(one_of({"refuse", "continue"}));
  verb.add_option("--stabilise", options.stabilise, "What keeps the constraints from drifting")
      ->check(one_of({"baumgarte", "projection"}));
  verb.add_option("--theta", options.theta, "Of moreau: 0.5 takes forces at the middle of a step, 1 at its start")
      ->check(from_zero_to_one());
  verb.add_flag("--quiet", options.quiet, "No table, no progress");
}

void add_run_options(CLI::App& verb, RunOptions& options) {
  add_step_options(verb, options);
  verb.add_option("--every", options.every, "CSV: each how-many-eth step is a row")
      ->check(CLI::Range(1LL, 1000000000000LL));
  verb.add_option("--csv", options.csv, "Write the trajectory; - is standard output");
}

std::optional<std::vector<double>> input_values(const StepOptions& options, const io::SceneFile& file) {
  std::vector<std::optional<double>> given(file.input_names.size());
  bool good = true;
  for (const std::string& input : options.inputs) {
    const std::size_t equals = input.find('=');
    const std::string name = input.substr(0, equals);
    const auto value = equals == std::string::npos ? std::nullopt : finite_number(input.substr(equals + 1));
    const auto found = std::find(file.input_names.begin(), file.input_names.end(), name);
    if (!value) {
      complain("--input {}: must be NAME=V with a number V", input);
    } else if (found == file.input_names.end()) {
      complain("--input {}: the scene has no such input{}", input, io::suggestion(name, file.input_names));
    } else {
      given[static_cast<std::size_t>(found - file.input_names.begin())] = value;
      continue;
    }
    good = false;
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i])
      complain("{}: input '{}' has no value: add --input {}=V", file.file, file.input_names[i], file.input_names[i]);
    good = good && given[i];
    values.push_back(given[i].value_or(0));
  }
  return good ? std::optional(values) : std::nullopt;
}

}  // namespace slideway::app
