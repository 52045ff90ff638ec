#include <fmt/format.h>

#include <iterator>
#include <slideway/io/csv.hpp>

namespace slideway::io {
namespace {

void add_coordinates(std::string& out, const SceneFile& file, char symbol) {
  for (int i = 0; i < file.scene.bodies; ++i) {
    const std::string column = fmt::format(",{}.{}", symbol, file.body_names[static_cast<std::size_t>(i)]);
    switch (coordinates(file.scene.body[i].joint)) {
      case 1:
        out += column;
        break;
      case 3:
        out += column + ".x" + column + ".y" + column + ".angle";
        break;
      default:
        break;
    }
  }
}

void add_names(std::string& out, const char* prefix, const std::vector<std::string>& names) {
  for (const std::string& name : names) fmt::format_to(std::back_inserter(out), ",{}.{}", prefix, name);
}

void add_values(std::string& out, const std::vector<double>& values) {
  for (const double value : values) fmt::format_to(std::back_inserter(out), ",{:.17g}", value);
}

}  // namespace

std::string csv_header(const SceneFile& file) {
  std::string out = "t";
  add_coordinates(out, file, 'q');
  add_coordinates(out, file, 'v');
  for (std::size_t g = 0; g < file.guide_names.size(); ++g) {
    for (int k = 0; k < file.scene.guide[g].contacts; ++k) out += fmt::format(",lambda.{}.{}", file.guide_names[g], k);
  }
  add_names(out, "friction", file.guide_names);
  add_names(out, "slip", file.guide_names);
  add_names(out, "mode", file.guide_names);
  add_names(out, "drive", file.drive_names);
  for (const std::string& pin : file.pin_names) out += fmt::format(",pin.{0}.x,pin.{0}.y", pin);
  return out + ",energy,work,dissipated,constraint_work,drift\n";
}

std::string csv_row(const Sample& sample) {
  std::string out = fmt::format("{:.17g}", sample.t);
  add_values(out, sample.q);
  add_values(out, sample.v);
  add_values(out, sample.lambda);
  add_values(out, sample.friction);
  add_values(out, sample.slip);
  for (const int mode : sample.mode) fmt::format_to(std::back_inserter(out), ",{}", mode);
  add_values(out, sample.drive);
  for (const Vec2 force : sample.pin) add_values(out, {force.x, force.y});
  add_values(out, {sample.energy, sample.work, sample.dissipated, sample.constraint_work, sample.drift});
  return out + '\n';
}

}  // namespace slideway::io
