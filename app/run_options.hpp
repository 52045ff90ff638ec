// What `slideway run` can be told.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene_source.hpp"
#include "verbs.hpp"

namespace slideway::app {

struct RunOptions {
  SceneOptions scene;
  std::optional<std::string> method;
  std::optional<double> dt, duration, alpha, beta;
  long long every = 1;
  std::string csv, json, report;
  bool project_start = false, quiet = false;
  std::vector<std::string> inputs;
  std::string not_unique = "refuse";
};

void add_run_options(CLI::App& verb, RunOptions& options);

/// The value of each input of the scene, in its order; nothing, and said, when one is missing, unknown or no number.
std::optional<std::vector<double>> input_values(const RunOptions& options, const io::SceneFile& file);

}  // namespace slideway::app
