// Draws docs/charts and writes bench/results.
//
//     draw_charts [--quick] [--root DIR] [NAME...]
//
// NAME: a scene, growth (of scenes) or detail (of one scene); all if none is given.
// --quick: coarse settings alone, to see that everything still draws; nothing that it writes is for docs.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "detail.hpp"
#include "embedded.hpp"
#include "growth.hpp"
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

/// Progress of a figure on a terminal.
std::function<void(double, const std::string&)> progress_of(const std::string& name) {
  return [name](double part, const std::string& what) {
    fmt::print(stderr, "\r\33[K{}: {:3.0f} % {}{}", name, 100 * part, what, part < 1 ? "" : "\r\33[K");
  };
}

void draw_growth(const Options& options) {
  const std::vector<Growth> growth = measure_growth(options.quick ? 1 : 7, progress_of("growth"));
  write(options.root / "docs/charts/growth.svg", svg(growth_chart(growth)));
  write(options.root / "docs/charts/growth_memory.svg", svg(memory_chart(growth)));
  write(options.root / "bench/results/growth.json", io::text(document(growth)));
}

void draw_detail(const Options& options) {
  io::Json json{{"format", io::json_format}, {"machines", io::Json::array()}};
  for (const Machine& machine : {driven_machine(), undriven_machine()}) {
    const std::vector<Detail> details = measure_detail(machine, options.quick ? 1 : 7, progress_of("detail"));
    const std::string name = fmt::format("detail_{}.svg", machine.name);
    write(options.root / "docs/charts" / name, svg(detail_chart(machine, details)));
    json["machines"].push_back(document(machine, details));
  }
  write(options.root / "bench/results/detail.json", io::text(json));
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
  const auto is_wanted = [&](const std::string& name) {
    return options.names.empty() || std::find(options.names.begin(), options.names.end(), name) != options.names.end();
  };
  for (const EmbeddedScene& scene : embedded_scenes()) {
    if (is_wanted(scene.name)) draw(scene, options);
  }
  if (is_wanted("growth")) draw_growth(options);
  if (is_wanted("detail")) draw_detail(options);
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
