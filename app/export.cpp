// slideway export: a scene as a constexpr C++ header.
#include <slideway/io/export.hpp>

#include "messages.hpp"
#include "output.hpp"
#include "scene_source.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

struct ExportOptions {
  SceneOptions scene;
  std::string output;
};

int export_scene(const ExportOptions& options) {
  const auto file = load_scene(options.scene.scene, options.scene.settings, Start::checked);
  if (!file) return bad_input;
  if (const std::string problem = io::export_problem(*file); !problem.empty()) {
    complain("{}: {}", file->file, problem);
    return bad_input;
  }
  Output output(options.output);
  if (!open_all({&output}, options.scene.scene)) return bad_input;
  output.write(io::export_header(*file));
  return output.close() ? good : bad_input;
}

}  // namespace

void add_export(CLI::App& command, int& status) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* verb = command.add_subcommand("export", "Write a scene as a constexpr C++ header, for embedding");
  add_scene_options(*verb, options->scene);
  verb->add_option("-o", options->output, "The header; - is standard output")->required();
  verb->callback([options, &status] { status = export_scene(*options); });
}

}  // namespace slideway::app
