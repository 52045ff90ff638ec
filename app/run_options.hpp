// What `slideway run` can be told, and `slideway verify` too for the most part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene_source.hpp"
#include "verbs.hpp"

namespace slideway::app {

/// How to step, and where the summary goes.
struct StepOptions {
  SceneOptions scene;
  std::optional<std::string> method;
  std::optional<double> dt, duration, alpha, beta;
  std::string json, report;
  bool project_start = false, quiet = false;
  std::vector<std::string> inputs;
  std::string not_unique = "refuse", stabilise = "baumgarte";
  double theta = 0.5;
};
void add_step_options(CLI::App& verb, StepOptions& options);

struct RunOptions : StepOptions {
  long long every = 1;
  std::string csv;
};
void add_run_options(CLI::App& verb, RunOptions& options);

/// The value of each input of the scene, in its order; nothing, and said, when one is missing, unknown or no number.
std::optional<std::vector<double>> input_values(const StepOptions& options, const io::SceneFile& file);

}  // namespace slideway::app
