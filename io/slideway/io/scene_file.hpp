// Scenes as TOML files: text -> Scene, or every defect of the text at once.
#pragma once

#include <array>
#include <optional>
#include <slideway/scene.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace slideway::io {

/// Room of scenes that are read at run time: bodies, coordinates, guides, contacts, drives, pins, springs, joint
/// springs, loads, inputs.
using RunSize = slideway::Size<64, 64, 32, 32, 32, 32, 32, 32, 32, 16>;

/// The methods that a scene or a command may ask for, by name.
const std::vector<std::string>& methods();

/// Defaults of `slideway run` that a scene may carry.
struct RunDefaults {
  std::string method = "rk4";
  double dt = 1e-3;     ///< s
  double duration = 1;  ///< s
};

struct SceneFile {
  std::string file;  ///< as the user named it; in front of every message
  std::string name;  ///< of the scene
  Scene<RunSize> scene;
  std::vector<std::string> body_names, guide_names, drive_names, pin_names, spring_names, joint_spring_names,
      load_names, input_names;
  RunDefaults run;
  std::string hash;                       ///< of the text, FNV-1a 64, 16 hex digits
  std::vector<std::string> settings;      ///< the `--set` options that were applied, as given
  std::array<std::vector<int>, 8> lines;  ///< where each item starts: lines[int(Item)][index]; 0: no line

  /// "guide 'slot'"; "scene" for the scene itself.
  std::string title(Item item, int index) const;
  int line(Item item, int index) const;
};

/// One thing that is wrong, where, and what to write instead.
struct FileDefect {
  std::string file;
  int line = 0;  ///< 0: the file as a whole
  std::string message;
};

/// FILE:LINE: message
std::string to_string(const FileDefect& defect);

/// A scene, or the defects that keep it from being one. A scene is there exactly when there is no defect.
struct Reading {
  std::optional<SceneFile> scene;
  std::vector<FileDefect> defects;
};

/// Largest scene text that is read, bytes; anything longer is refused before it is parsed.
inline constexpr std::size_t largest_text = 1 << 20;

/// `settings` are overrides PATH=VALUE, as in guide.slot.mu=0.3, applied before anything is checked.
/// The start pose is not checked here: see start.hpp.
Reading parse_scene(std::string_view text, const std::string& file, const std::vector<std::string>& settings = {});
Reading read_scene(const std::string& file, const std::vector<std::string>& settings = {});

}  // namespace slideway::io
