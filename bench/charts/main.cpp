// slideway-charts: speed against accuracy, and where methods fail. `slideway chart` and `slideway atlas` are handed to
// it; `docs` draws docs/charts and writes bench/results.
#include <fmt/format.h>
#include <scene_source.hpp>
#include <stdexcept>
#include <verbs.hpp>

#include "boards.hpp"

namespace slideway::charts {
namespace {

using app::good, app::refused, app::bad_input;

struct Options {
  app::SceneOptions scene;
  std::string atlas, directory = ".", root = SLIDEWAY_SOURCE_DIR;
  std::vector<std::string> names;
  bool quick = false;
};

/// Its directories are made before the work.
Session session_of(const Options& options, const std::string& command, const std::filesystem::path& charts,
                   const std::filesystem::path& results) {
  for (const std::filesystem::path& directory : {charts, results}) {
    std::error_code failure;
    std::filesystem::create_directories(directory, failure);
    if (failure) throw std::runtime_error(directory.string() + ": " + failure.message() + "; name another directory");
  }
  return {options.quick, charts, results, provenance(command, SLIDEWAY_SOURCE_DIR)};
}

/// A map or a scene by name, with the names that there are.
template <class Entry>
const Entry& find(const std::vector<Entry>& entries, const std::string& name) {
  std::string known;
  for (const Entry& entry : entries) {
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw CLI::ValidationError(fmt::format("'{}' is not one of: {}", name, known));
}

int chart(const Options& options) {
  const auto scene = app::load_scene(options.scene.scene, options.scene.settings, app::Start::checked);
  if (!scene) return bad_input;
  std::string command = "slideway chart " + options.scene.scene;
  for (const std::string& setting : options.scene.settings) command += " --set " + setting;
  return draw_scene(*scene, session_of(options, command, options.directory, options.directory)) ? good : refused;
}

int atlas_map(const Options& options) {
  const std::vector<Board> maps = atlas_boards();
  find(maps, options.atlas)
      .draw(session_of(options, "slideway atlas " + options.atlas, options.directory, options.directory));
  return good;
}

int docs(const Options& options) {
  const std::filesystem::path root = options.root;
  for (const std::string& name : options.names) find(boards(), name);
  for (const Board& board : boards()) {
    const bool wanted = options.names.empty() ||
                        std::find(options.names.begin(), options.names.end(), board.name) != options.names.end();
    if (!wanted) continue;
    board.draw(session_of(options, "./dev charts " + board.name, root / "docs/charts", root / "bench/results"));
  }
  return good;
}

int run(int count, char** arguments) {
  CLI::App command("Speed against accuracy, and where methods fail.", "slideway-charts");
  command.require_subcommand(1);
  Options options;
  int status = good;

  CLI::App* one = command.add_subcommand("chart",
                                         "Chart a scene's error against time: SCENE_time.svg, _evaluations, "
                                         "_forces, SCENE.json");
  app::add_scene_options(*one, options.scene);
  one->callback([&] { status = chart(options); });

  CLI::App* map = command.add_subcommand("atlas", "Map where methods fail: NAME_*.svg, NAME.json");
  map->add_option("NAME", options.atlas, "baumgarte, friction, pole, stick_slip, mass_ratio, singular, long_run, units")
      ->required();
  map->callback([&] { status = atlas_map(options); });

  CLI::App* all = command.add_subcommand("docs", "Everything into docs/charts and bench/results, or what is named");
  all->add_option("NAME", options.names, "A charted scene, engines, hlcp_kind, hlcp_hard, growth, detail, or a map");
  all->add_option("--root", options.root, "Write to DIR/docs/charts and DIR/bench/results");
  all->callback([&] { status = docs(options); });

  for (CLI::App* verb : {one, map, all}) {
    verb->add_flag("--quick", options.quick, "Coarse settings alone, to see that everything still draws");
    if (verb != all) verb->add_option("-o,--output", options.directory, "Directory to write to");
  }
  try {
    command.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return command.exit(error);
    fmt::print(stderr, "slideway-charts: {}; --help shows what there is\n", error.what());
    return bad_input;
  }
  return status;
}

}  // namespace
}  // namespace slideway::charts

int main(int count, char** arguments) {
  try {
    return slideway::charts::run(count, arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "slideway-charts: {}\n", error.what());
    return slideway::app::bad_input;
  }
}
