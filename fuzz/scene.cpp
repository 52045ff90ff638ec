// Scene texts: a scene or defects, never both. A scene has no defects, reads back from its own text, and each method
// steps it or refuses.
#include <algorithm>
#include <slideway/io/scene_file.hpp>
#include <slideway/properties/mechanism.hpp>
#include <string_view>

#include "support/fail.hpp"
#include "support/steps.hpp"

const char* const slideway::fuzz::target = "scene";

namespace {

using namespace slideway;
using namespace slideway::fuzz;

const std::string file = "fuzz.toml";

/// One line that names the file and can be shown on a terminal.
void hold_defect(const io::FileDefect& defect, std::string_view text) {
  const std::string line = to_string(defect);
  const bool printable = std::all_of(line.begin(), line.end(), [](char c) { return c < 0 || (c >= ' ' && c != 127); });
  if (!line.starts_with(file + ":") || defect.message.empty() || !printable) fail("a defect is not a line: " + line);
  if (defect.line < 0 || defect.line > 1 + std::count(text.begin(), text.end(), '\n'))
    fail("a defect is at a line that is not there: " + line);
}

io::Reading read(std::string_view text) {
  io::Reading reading = io::parse_scene(text, file);
  if (reading.scene.has_value() != reading.defects.empty()) fail("a scene with defects, or neither");
  for (const io::FileDefect& defect : reading.defects) hold_defect(defect, text);
  if (reading.scene && defects(reading.scene->scene).count > 0) fail("a scene that is read has defects");
  return reading;
}

/// TOML's integer -0 is 0.
std::string without_negative_zeros(std::string text) {
  for (const char* end : {"-0,", "-0]", "-0\n"}) {
    for (std::size_t at = 0; (at = text.find(end, at)) != text.npos;) {
      if (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '['))
        text.erase(at, 1);
      else
        ++at;
    }
  }
  return text;
}

/// toml() writes every number but what follows from others, with all digits, and no input.
void hold_text(const io::SceneFile& scene) {
  if (scene.scene.inputs > 0) return;
  const std::string text = properties::toml(scene.scene);
  const io::Reading again = read(text);
  if (!again.scene) fail("its own text is not read: " + to_string(again.defects.front()));
  if (without_negative_zeros(properties::toml(again.scene->scene)) != without_negative_zeros(text))
    fail("its own text reads as another scene");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const io::Reading reading = read(text);
  if (!reading.scene) return 0;
  hold_text(*reading.scene);
  RunStepper stepper(reading.scene->scene);
  stepper.hlcp.max_solves = 64;
  for (const Method method : methods) {
    stepper.method = method;
    RunState state = stepper.start();
    step(stepper, state, reading.scene->run.dt);
  }
  return 0;
}
