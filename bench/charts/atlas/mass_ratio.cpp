// Digits that are left of the contact forces of a driven slider-crank as its rod becomes light: by the elimination as
// it is written (M^-1 and two Schur complements, WWZ14 (13)-(19)) and by LU of the whole system, both in Cartesian
// coordinates, and by the kernel's. Judge: the oracle, in 50 digits.
#include <algorithm>
#include <cmath>

#include "exact_instant.hpp"
#include "full_system.hpp"

namespace slideway::charts {
namespace {

std::vector<double> by_the_kernel(const RunScene& scene, const State& state) {
  const io::RunStepper stepper(scene);
  io::RunStepper::Reaction r;
  if (stepper.reaction(state, {}, r).status != Status::ok) return {};
  return {r.lambda, r.lambda + stepper.source.tables.contacts};
}

struct Way {
  std::string name;
  std::vector<double> (*forces)(const RunScene&, const State&);
  Style style;
};
const Way ways[] = {{"slideway", by_the_kernel, {0, 0, false}},
                    {"the whole system, LU", forces_by_lu, {2, 2, false}},
                    {"inverses, as published", forces_by_inverses, {1, 1, false}}};

}  // namespace

AtlasMap draw_mass_ratio(const AtlasOptions& options) {
  AtlasMap map = begin_map("mass_ratio");
  map.document.erase("maps");
  const RunScene given = options.scene("high_mass_ratio");
  Chart chart{"Driven slider-crank with a light rod",
              "",
              {"mass of crank and slider over the rod's", 1, 1e16, true},
              {"relative error of the contact forces", 1e-17, 1, true},
              {},
              {}};
  Line bound{"bound on rounding of the state", {6, -1, true}, {}, {}};
  for (const Way& way : ways) chart.lines.push_back({way.name, way.style, {}, {}});
  io::Json rows = io::Json::array();
  int wrong[std::size(ways)] = {}, refused[std::size(ways)] = {};
  for (const double ratio : decades(0, 16, options.quick ? 1 : 4)) {
    RunScene scene = given;
    scene.body[1].mass = 1 / ratio;
    scene.body[1].inertia = given.body[1].inertia / given.body[1].mass / ratio;
    const State state = io::RunStepper(scene).start();
    const ExactInstant exact(scene, state);
    bound.points.push_back({ratio, exact.relative_bound()});
    io::Json row{{"ratio", ratio}, {"bound", exact.relative_bound()}};
    for (std::size_t k = 0; k < std::size(ways); ++k) {
      const auto lambda = ways[k].forces(scene, state);
      const double error = lambda.empty() ? 1 : exact.relative_error(lambda);
      // Wrong: no six digits are left where rounding leaves them.
      refused[k] += lambda.empty() ? 1 : 0;
      wrong[k] += !lambda.empty() && exact.judge(lambda, 1e-6) == Cell::wrong ? 1 : 0;
      if (!lambda.empty()) chart.lines[k].points.push_back({ratio, std::clamp(error, 1e-17, 1.0)});
      row[ways[k].name] = lambda.empty() ? io::Json() : io::Json(error);
    }
    rows.push_back(std::move(row));
  }
  chart.lines.push_back(bound);
  map.document["errors"] = std::move(rows);
  for (std::size_t k = 0; k < std::size(ways); ++k) {
    map.document["wrong_in_silence"][ways[k].name] = wrong[k];
    map.document["refused"][ways[k].name] = refused[k];
    chart.subtitle += (k > 0 ? ", " : "wrong in silence: ") + ways[k].name + " " + std::to_string(wrong[k]);
  }
  map.figures.push_back({"mass_ratio", chart});
  return map;
}

}  // namespace slideway::charts
