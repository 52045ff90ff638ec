#include "scene_source.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <slideway/embedded/scenes.hpp>
#include <slideway/io/start.hpp>
#include <slideway/io/text.hpp>

#include "messages.hpp"

namespace slideway::app {
namespace {

void complain_all(const std::vector<io::FileDefect>& defects) {
  constexpr std::size_t most = 100;
  for (std::size_t i = 0; i < std::min(most, defects.size()); ++i) complain(to_string(defects[i]));
  if (defects.size() > most) complain("{}: {} more defects", defects[0].file, defects.size() - most);
}

io::Reading read(const std::string& scene, const std::vector<std::string>& settings) {
  std::error_code error;
  if (scene == "-" || std::filesystem::is_regular_file(scene, error)) return io::read_scene(scene, settings);
  std::vector<std::string> names;
  for (const ShippedScene& shipped : shipped_scenes()) {
    if (shipped.name == scene) return io::parse_scene(shipped.text, scene, settings);
    names.emplace_back(shipped.name);
  }
  if (std::filesystem::exists(scene, error)) return io::read_scene(scene, settings);
  const std::string near = io::nearest(scene, names);
  return {std::nullopt,
          {{scene, 0,
            "is neither a file nor a shipped scene; " +
                (near.empty() ? "`slideway scenes` lists those" : "did you mean " + near + "?")}}};
}

}  // namespace

const std::vector<ShippedScene>& shipped_scenes() {
  static const std::vector<ShippedScene> scenes = [] {
    std::vector<ShippedScene> list;
    for (const auto& [file, text] : embedded::scenes) list.push_back({file.substr(0, file.rfind('.')), text});
    return list;
  }();
  return scenes;
}

std::optional<io::SceneFile> load_scene(const std::string& scene, const std::vector<std::string>& settings,
                                        Start start) {
  io::Reading reading = read(scene, settings);
  if (reading.scene) {
    reading.defects = io::check_masses(*reading.scene);
    if (start == Start::checked)
      std::ranges::move(io::check_start(*reading.scene), std::back_inserter(reading.defects));
  }
  if (reading.defects.empty()) return std::move(reading.scene);
  complain_all(reading.defects);
  return std::nullopt;
}

}  // namespace slideway::app
