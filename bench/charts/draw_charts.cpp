// Draws docs/charts and writes bench/results.
//
//     draw_charts [--quick] [--root DIR] [SCENE | MAP...]     a map of the stability atlas: atlas.hpp
//
// --quick: coarse settings alone, to see that everything still draws; nothing that it writes is for docs.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "atlas.hpp"
#include "embedded.hpp"
#include "kernel_contender.hpp"
#include "work_precision.hpp"

namespace slideway::charts {
namespace {

namespace fs = std::filesystem;

struct Options {
  bool quick = false;
  fs::path root = SLIDEWAY_SOURCE_DIR;
  std::vector<std::string> names;
};

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

io::Json read_json(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  return io::Json::parse(in);
}

void draw(const EmbeddedScene& embedded, const Options& options) {
  const fs::path source = SLIDEWAY_SOURCE_DIR;
  io::Reading reading = io::read_scene((source / "scenes" / (embedded.name + ".toml")).string(), {});
  if (!reading.scene) throw std::runtime_error(to_string(reading.defects.at(0)));
  WorkPrecision wp{std::move(*reading.scene),
                   oracle::reference_of(read_json(source / "oracle/references" / (embedded.name + ".json"))),
                   {},
                   {}};
  const double interval = wp.reference.duration / oracle::reference_intervals;
  embedded.add(interval, wp.contenders);
  add_methods(io::RunStepper(wp.scene.scene), interval, ", run time", wp.contenders);
  add_sundials(wp.scene.scene, wp.contenders);
  MeasureOptions how;
  if (options.quick) {
    how.longest = 1e-3;
    how.repetitions = 1;
  }
  how.progress = [&](double part, const std::string& what) {
    fmt::print(stderr, "\r\33[K{}: {:3.0f} % {}", embedded.name, 100 * part, what);
  };
  wp.measured = measure(wp.contenders, wp.reference, how);
  fmt::print(stderr, "\r\33[K");
  const fs::path charts = options.root / "docs/charts";
  write(charts / (embedded.name + "_time.svg"), svg(time_chart(wp)));
  write(charts / (embedded.name + "_evaluations.svg"), svg(evaluations_chart(wp)));
  write(charts / (embedded.name + "_forces.svg"), svg(force_chart(wp)));
  const io::Json json = document(wp);
  write(options.root / "bench/results" / (embedded.name + ".json"), io::text(json));
  for (const auto& row : json["cheapest"]) {
    if (!row.contains("method")) continue;
    fmt::print("{:22s} {:7.0e} {:15s} {:10.0f} ns/s", embedded.name, row["error"].get<double>(),
               row["method"].get<std::string>(), row["ns_per_second"].get<double>());
    for (const auto& [family, peer] : row["times_dearer"].items())
      fmt::print(" | {:.1f} x {}", peer["ratio"].get<double>(), family);
    fmt::print("\n");
  }
}

void draw(const AtlasEntry& entry, const Options& options) {
  AtlasOptions how;
  how.quick = options.quick;
  how.scene = [](const std::string& name) {
    io::Reading reading = io::read_scene((fs::path(SLIDEWAY_SOURCE_DIR) / "scenes" / (name + ".toml")).string(), {});
    if (!reading.scene) throw std::runtime_error(to_string(reading.defects.at(0)));
    return reading.scene->scene;
  };
  how.progress = [&](double part, const std::string& what) {
    fmt::print(stderr, "\r\33[K{}: {:3.0f} % {}", entry.name, 100 * part, what);
  };
  const AtlasMap map = entry.draw(how);
  fmt::print(stderr, "\r\33[K");
  for (const NamedFigure& figure : map.figures) {
    write(options.root / "docs/charts" / (figure.name + ".svg"),
          std::visit([](const auto& drawing) { return svg(drawing); }, figure.figure));
  }
  write(options.root / "bench/results" / (map.name + ".json"), io::text(map.document));
  if (!map.document.contains("maps")) return;
  for (const auto& figure : map.document["maps"]) {
    fmt::print("{:10s} {:34s} {}\n", map.name, figure["name"].get<std::string>(), figure["counts"].dump());
  }
}

int run(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--quick") == 0) {
      options.quick = true;
    } else if (std::strcmp(arguments[i], "--root") == 0 && i + 1 < count) {
      options.root = arguments[++i];
    } else {
      options.names.emplace_back(arguments[i]);
    }
  }
  const auto wanted = [&](const std::string& name) {
    return options.names.empty() || std::find(options.names.begin(), options.names.end(), name) != options.names.end();
  };
  for (const EmbeddedScene& scene : embedded_scenes()) {
    if (wanted(scene.name)) draw(scene, options);
  }
  for (const AtlasEntry& entry : atlas()) {
    if (wanted(entry.name)) draw(entry, options);
  }
  return 0;
}

}  // namespace
}  // namespace slideway::charts

int main(int count, char** arguments) {
  try {
    return slideway::charts::run(count, arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "draw_charts: {}\n", error.what());
    return 1;
  }
}
