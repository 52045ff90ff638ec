// Draws docs/charts and writes bench/results.
//
//     draw_charts [--quick] [--root DIR] [NAME...]      a scene, or engines
//
// --quick: coarse settings alone, to see that everything still draws; nothing that it writes is for docs.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "embedded.hpp"
#include "engines_chart.hpp"
#include "kernel_contender.hpp"
#include "work_precision.hpp"

namespace slideway::charts {
namespace {

namespace fs = std::filesystem;

struct Options {
  bool quick = false;
  fs::path root = SLIDEWAY_SOURCE_DIR;
  std::vector<std::string> names;

  bool wants(const std::string& name) const {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  }
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

/// A shipped scene and its reference.
std::pair<io::SceneFile, oracle::Reference> read_scene(const std::string& name) {
  const fs::path source = SLIDEWAY_SOURCE_DIR;
  io::Reading reading = io::read_scene((source / "scenes" / (name + ".toml")).string(), {});
  if (!reading.scene) throw std::runtime_error(to_string(reading.defects.at(0)));
  return {std::move(*reading.scene), oracle::reference_of(read_json(source / "oracle/references" / (name + ".json")))};
}

MeasureOptions how_to_measure(const std::string& name, const Options& options) {
  MeasureOptions how;
  if (options.quick) {
    how.longest = 1e-3;
    how.repetitions = 1;
  }
  how.progress = [name](double part, const std::string& what) {
    fmt::print(stderr, "\r\33[K{}: {:3.0f} % {}", name, 100 * part, what);
  };
  return how;
}

void draw_engines(const Options& options) {
  const auto [scene, reference] = read_scene(engine_scene);
  MeasureOptions how = how_to_measure("engines", options);
  how.longest = std::min(how.longest, 0.1);  // there are a hundred settings
  const EngineComparison with = compare_engines(scene, reference, true, how);
  const EngineComparison without = compare_engines(scene, reference, false, how);
  fmt::print(stderr, "\r\33[K");
  write(options.root / "docs/charts/engines.svg", svg(engines_chart(with)));
  write(options.root / "docs/charts/engines_frictionless.svg", svg(engines_chart(without)));
  write(options.root / "bench/results/engines.json", io::text(document(with, without)));
  for (const EngineComparison* comparison : {&with, &without}) {
    for (const Engine& engine : engines()) {
      if (engine.version.empty()) fmt::print("missing: {}\n", engine.name);
      const std::vector<StepRatio> ratios = step_ratios(*comparison, engine);
      const StepRatio* least = least_ratio(ratios);
      if (least == nullptr) continue;
      fmt::print(
          "mu = {:g}: a step of {} is at least {:.1f} times as dear: {:.0f} ns ({}, {}; error {:.1e} at best), of "
          "slideway {:.0f} ns ({}, error {:.1e})\n",
          comparison->scene->guide[0].mu, engine.name, least->ratio(), least->engine_ns(),
          least->engine->contender->family, least->engine->contender->name, least->least_error, least->kernel_ns(),
          least->kernel->contender->family, least->kernel->error);
    }
  }
}

void draw(const EmbeddedScene& embedded, const Options& options) {
  auto [scene, reference] = read_scene(embedded.name);
  WorkPrecision wp{std::move(scene), std::move(reference), {}, {}};
  const double interval = wp.reference.duration / oracle::reference_intervals;
  embedded.add(interval, wp.contenders);
  add_methods(io::RunStepper(wp.scene.scene), interval, ", run time", wp.contenders);
  add_sundials(wp.scene.scene, wp.contenders);
  wp.measured = measure(wp.contenders, wp.reference, how_to_measure(embedded.name, options));
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
  for (const EmbeddedScene& scene : embedded_scenes()) {
    if (options.wants(scene.name)) draw(scene, options);
  }
  if (options.wants("engines")) draw_engines(options);
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
