// Writes the reference of each scene file given: references DIRECTORY SCENE.toml...
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <slideway/oracle/reference.hpp>

using namespace slideway;

namespace {

bool write_reference(const std::string& directory, const std::string& file) {
  const io::Reading reading = io::read_scene(file);
  for (const io::FileDefect& defect : reading.defects) fmt::print(stderr, "{}\n", to_string(defect));
  if (!reading.scene) return false;
  const bool shown = isatty(STDERR_FILENO) == 1;
  const auto reference = oracle::make_reference(*reading.scene, [&](double done) {
    if (shown) fmt::print(stderr, "\r{:5.1f} % of {} ", 100 * done, reading.scene->name);
  });
  if (shown) fmt::print(stderr, "\r{:40}\r", "");
  if (reference.trajectory.end != oracle::End::duration && reference.trajectory.t == 0) {
    fmt::print("{:<28}has no trajectory: it cannot start\n", reading.scene->name);
    return true;  // three_contacts; tests/references.cpp says which ones may
  }
  if (reference.trajectory.end != oracle::End::duration) {
    fmt::print(stderr, "{}: its trajectory ends at t = {:.9g} s, before the duration: shorten [run] duration\n", file,
               static_cast<double>(reference.trajectory.t));
    return false;
  }
  const std::string name = fmt::format("{}/{}.json", directory, reading.scene->name);
  std::ofstream out(name);
  out << io::text(oracle::to_json(reference));
  fmt::print("{:<28}{:>5.0f} digits {:>5} events {:>6} steps\n", reading.scene->name, reference.digits,
             reference.trajectory.events.size(), reference.trajectory.steps);
  if (out.flush()) return true;
  fmt::print(stderr, "{}: cannot be written\n", name);
  return false;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    fmt::print(stderr, "references DIRECTORY SCENE.toml...\n");
    return 2;
  }
  bool good = true;
  for (int i = 2; i < count; ++i) good = write_reference(arguments[1], arguments[i]) && good;
  return good ? 0 : 1;
}
