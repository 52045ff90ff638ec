// What can be drawn, by name.
#pragma once

#include <functional>
#include <slideway/io/scene_file.hpp>
#include <string>
#include <vector>

#include "session.hpp"

namespace slideway::charts {

/// Figures and numbers that are drawn together.
struct Board {
  std::string name;
  std::function<void(const Session&)> draw;
};
/// Each charted scene, engines, HLCP solvers, growth, detail, and the maps of the atlas.
const std::vector<Board>& boards();
std::vector<Board> atlas_boards();

/// Error against time of a scene, whose reference is computed first. False, and said on standard error, where it has no
/// trajectory for the whole duration.
bool draw_scene(const io::SceneFile& scene, const Session& session);

}  // namespace slideway::charts
