#include "boards.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "atlas/atlas.hpp"
#include "engines/engines_chart.hpp"
#include "growth/detail.hpp"
#include "growth/growth.hpp"
#include "hlcp/charts.hpp"
#include "motion/embedded.hpp"
#include "motion/kernel_contender.hpp"
#include "motion/work_precision.hpp"

namespace slideway::charts {
namespace {

const std::filesystem::path source = SLIDEWAY_SOURCE_DIR;

io::SceneFile read_scene(const std::string& name) {
  io::Reading reading = io::read_scene((source / "scenes" / (name + ".toml")).string(), {});
  if (!reading.scene) throw std::runtime_error(to_string(reading.defects.at(0)));
  return std::move(*reading.scene);
}

oracle::Reference read_reference(const std::string& name) {
  const std::filesystem::path file = source / "oracle/references" / (name + ".json");
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  return oracle::reference_of(io::Json::parse(in));
}

int repetitions(const Session& session) { return session.quick ? 1 : 7; }

MeasureOptions how_to_measure(const Session& session, const std::string& name) {
  MeasureOptions how;
  if (session.quick) {
    how.longest = 1e-3;
    how.repetitions = 1;
  }
  how.progress = session.progress(name);
  return how;
}

// --- error against time

void print_cheapest(const std::string& name, const io::Json& rows) {
  for (const auto& row : rows) {
    if (!row.contains("method")) continue;
    fmt::print("{:22s} {:7.0e} {:15s} {:10.0f} ns/s", name, row["error"].get<double>(),
               row["method"].get<std::string>(), row["ns_per_second"].get<double>());
    for (const auto& [family, peer] : row["times_dearer"].items())
      fmt::print(" | {:.1f} x {}", peer["ratio"].get<double>(), family);
    fmt::print("\n");
  }
}

void measure_and_draw(WorkPrecision& wp, const Session& session) {
  add_sundials(wp.scene.scene, wp.contenders);
  wp.measured = measure(wp.contenders, wp.reference, how_to_measure(session, wp.scene.name));
  session.draw(wp.scene.name + "_time", time_chart(wp));
  session.draw(wp.scene.name + "_evaluations", evaluations_chart(wp));
  session.draw(wp.scene.name + "_forces", force_chart(wp));
  const io::Json json = document(wp);
  session.write(wp.scene.name, json);
  print_cheapest(wp.scene.name, json["cheapest"]);
}

double interval(const WorkPrecision& wp) { return wp.reference.duration / oracle::reference_intervals; }

void draw_embedded(const EmbeddedScene& embedded, const Session& session) {
  WorkPrecision wp{read_scene(embedded.name), read_reference(embedded.name), {}, {}};
  embedded.add(interval(wp), wp.contenders);
  add_methods(io::RunStepper(wp.scene.scene), interval(wp), ", run time", wp.contenders);
  measure_and_draw(wp, session);
}

// --- peers

void print_least(const EngineComparison& comparison, const Engine& engine) {
  if (engine.version.empty()) fmt::print("missing: {}\n", engine.name);
  const std::vector<StepRatio> ratios = step_ratios(comparison, engine);
  const StepRatio* least = least_ratio(ratios);
  if (least == nullptr) return;
  fmt::print(
      "mu = {:g}: a step of {} costs at least {:.1f} of slideway's: {:.0f} ns ({}, {}; error {:.1e} at best), {:.0f} "
      "ns ({}, error {:.1e})\n",
      comparison.scene->guide[0].mu, engine.name, least->ratio(), least->engine_ns(), least->engine->contender->family,
      least->engine->contender->name, least->least_error, least->kernel_ns(), least->kernel->contender->family,
      least->kernel->error);
}

void draw_engines(const Session& session) {
  const io::SceneFile scene = read_scene(engine_scene);
  const oracle::Reference reference = read_reference(engine_scene);
  MeasureOptions how = how_to_measure(session, "engines");
  how.longest = std::min(how.longest, 0.1);  // there are a hundred settings
  const EngineComparison with = compare_engines(scene, reference, true, how);
  const EngineComparison without = compare_engines(scene, reference, false, how);
  session.draw("engines", engines_chart(with));
  session.draw("engines_frictionless", engines_chart(without));
  session.write("engines", document(with, without));
  for (const EngineComparison* comparison : {&with, &without}) {
    for (const Engine& engine : engines()) print_least(*comparison, engine);
  }
}

void draw_hlcp(HlcpBoard board, const Session& session) {
  HlcpEffort effort;
  if (session.quick) {
    effort.cases = 4;
    effort.repetitions = 1;
    effort.least = 1e-4;
    effort.most_exact = 4;
  }
  effort.progress = session.progress(board.name);
  board.measured = measure_hlcp(board.families(), effort);
  session.draw(board.name, hlcp_chart(board));
  session.write(board.name, document(board));
  for (const std::string& line : bars(board)) fmt::print("{}\n", line);
}

// --- cost of a model

void draw_growth(const Session& session) {
  const std::vector<Growth> growth = measure_growth(repetitions(session), session.progress("growth"));
  session.draw("growth", growth_chart(growth));
  session.draw("growth_memory", memory_chart(growth));
  session.write("growth", document(growth));
}

void draw_detail(const Session& session) {
  io::Json json{{"format", io::json_format}, {"machines", io::Json::array()}};
  for (const Machine& machine : {driven_machine(), undriven_machine()}) {
    const std::vector<Detail> details = measure_detail(machine, repetitions(session), session.progress("detail"));
    session.draw("detail_" + machine.name, detail_chart(machine, details));
    json["machines"].push_back(document(machine, details));
  }
  session.write("detail", json);
}

// --- atlas

void draw_map(const AtlasEntry& entry, const Session& session) {
  AtlasOptions how;
  how.quick = session.quick;
  how.scene = [](const std::string& name) { return read_scene(name).scene; };
  how.progress = session.progress(entry.name);
  const AtlasMap map = entry.draw(how);
  for (const NamedFigure& figure : map.figures)
    std::visit([&](const auto& drawing) { session.draw(figure.name, drawing); }, figure.figure);
  session.write(map.name, map.document);
  if (!map.document.contains("maps")) return;
  for (const auto& figure : map.document["maps"])
    fmt::print("{:10s} {:34s} {}\n", map.name, figure["name"].get<std::string>(), figure["counts"].dump());
}

}  // namespace

std::vector<Board> atlas_boards() {
  std::vector<Board> all;
  for (const AtlasEntry& entry : atlas())
    all.push_back({entry.name, [&entry](const Session& session) { draw_map(entry, session); }});
  return all;
}

const std::vector<Board>& boards() {
  static const std::vector<Board> all = [] {
    std::vector<Board> list;
    for (const EmbeddedScene& scene : embedded_scenes())
      list.push_back({scene.name, [&scene](const Session& session) { draw_embedded(scene, session); }});
    list.push_back({"engines", draw_engines});
    for (const HlcpBoard& board : hlcp_boards())
      list.push_back({board.name, [board](const Session& session) { draw_hlcp(board, session); }});
    list.push_back({"growth", draw_growth});
    list.push_back({"detail", draw_detail});
    for (const Board& map : atlas_boards()) list.push_back(map);
    return list;
  }();
  return all;
}

bool draw_scene(const io::SceneFile& scene, const Session& session) {
  const Progress progress = session.progress(scene.name);
  WorkPrecision wp{scene, oracle::make_reference(scene, [&](double done) { progress(done, "reference"); }), {}, {}};
  progress(1, "");
  if (wp.reference.trajectory.end != oracle::End::duration) {
    fmt::print(stderr, "{}: its trajectory ends at t = {:.9g} s: shorten [run] duration\n", scene.file,
               static_cast<double>(wp.reference.trajectory.t));
    return false;
  }
  add_methods(io::RunStepper(wp.scene.scene), interval(wp), "", wp.contenders);
  measure_and_draw(wp, session);
  return true;
}

}  // namespace slideway::charts
