// The verbs of the command: each adds its options to the command line and, when chosen, sets the exit status.
#pragma once

#include <CLI/CLI.hpp>

namespace slideway::app {

/// Exit status: good; refused by the kernel or not verified; bad input, usage or output.
enum Exit : int { good = 0, refused = 1, bad_input = 2 };

void add_run(CLI::App& command, int& status);
void add_verify(CLI::App& command, int& status);
void add_lint(CLI::App& command, int& status);
void add_hlcp(CLI::App& command, int& status);
void add_export(CLI::App& command, int& status);
void add_charts(CLI::App& command, int& status);
void add_scenes(CLI::App& command, int& status);

/// The positional SCENE and the repeatable --set.
struct SceneOptions {
  std::string scene;
  std::vector<std::string> settings;
};
void add_scene_options(CLI::App& verb, SceneOptions& options);

}  // namespace slideway::app
