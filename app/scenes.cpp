// slideway scenes: what is shipped.
#include <fmt/format.h>

#include "scene_source.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

/// The first sentence of the comment that a scene begins with.
std::string summary(std::string_view text) {
  std::string comment;
  while (text.starts_with('#')) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(1, end - 1);
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    comment += (comment.empty() ? "" : " ") + std::string(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  constexpr std::size_t shortest = 20;  // "A gantry:" tells less than its sentence
  const std::size_t stop = std::min(comment.find(". "), comment.find(": ", shortest));
  if (stop == std::string::npos) return comment;
  return comment.substr(0, stop) + ".";
}

}  // namespace

void add_scenes(CLI::App& command, int&) {
  command.add_subcommand("scenes", "List the shipped scenes")->callback([] {
    for (const ShippedScene& scene : shipped_scenes()) fmt::print("{:<28}{}\n", scene.name, summary(scene.text));
  });
}

}  // namespace slideway::app
