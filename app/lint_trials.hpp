// What lint tries: the scene and the scene less something, stepped side by side.
#pragma once

#include <slideway/io/scene_file.hpp>
#include <string>
#include <vector>

namespace slideway::app {

/// Something that a scene models beyond need.
struct Remark {
  Item item;
  int index;
  std::string message;
};

/// What the scene's first steps would hardly miss, with what leaving it out changes in them. Nothing of items that
/// there are remarks on already, where the kernel refuses the first step, or where live inputs would have to be
/// guessed.
std::vector<Remark> remarks_by_trial(const io::SceneFile& file, const std::vector<Remark>& known);

}  // namespace slideway::app
