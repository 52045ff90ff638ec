#include "verbs.hpp"

namespace slideway::app {

void add_scene_options(CLI::App& verb, SceneOptions& options) {
  verb.add_option("SCENE", options.scene, "A scene file, - for standard input, or the name of a shipped scene")
      ->required();
  verb.add_option("--set", options.settings, "Replace one value of the scene, as in guide.slot.mu=0.3")
      ->allow_extra_args(false);
}

}  // namespace slideway::app
