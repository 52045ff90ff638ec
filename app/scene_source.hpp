// Where scenes come from: a file, standard input, or the shipped ones that are compiled in.
#pragma once

#include <optional>
#include <slideway/io/scene_file.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace slideway::app {

enum class Start { checked, projected };  ///< projected: the start pose need not satisfy the constraints

/// The scene called `scene`; nothing when it has defects, which are then on standard error, all of them.
std::optional<io::SceneFile> load_scene(const std::string& scene, const std::vector<std::string>& settings,
                                        Start start);

struct ShippedScene {
  std::string_view name, text;
};
const std::vector<ShippedScene>& shipped_scenes();

}  // namespace slideway::app
