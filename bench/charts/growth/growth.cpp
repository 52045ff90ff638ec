#include "growth.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "timing.hpp"

namespace slideway::charts {
namespace {

constexpr const char* dense_family = "dense rows and LU";
constexpr int stages = 4;  // of rk4, each with an HLCP

/// What the contact forces of n sliders cost where nothing is known of the rows' zeros, without anything else of a
/// step: S = N N' and S* = N T' over n + 1 coordinates, and one LU of order n, in each stage.
GrowthCase dense_work(int n) {
  struct Problem {
    Eigen::MatrixXd N, T, S, S_star;
    Eigen::VectorXd b, x;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  };
  const auto p = std::make_shared<Problem>();
  p->N = Eigen::MatrixXd::Random(n, n + 1);
  p->T = Eigen::MatrixXd::Random(n, n + 1);
  p->S = p->S_star = Eigen::MatrixXd::Zero(n, n);
  p->b = Eigen::VectorXd::Ones(n);
  const auto run = [p] {
    for (int k = 0; k < growth_steps * stages; ++k) {
      p->S.noalias() = p->N * p->N.transpose();
      p->S_star.noalias() = p->N * p->T.transpose();
      p->S += 0.05 * p->S_star;
      p->lu.compute(p->S);
      p->x = p->lu.solve(p->b);
    }
    return std::isfinite(p->x.sum()) ? 1 : 0;
  };
  return {dense_family, n, 1, n, {}, run};
}

const Growth* find(const std::vector<Growth>& growth, const std::string& family, int sliders) {
  for (const Growth& g : growth) {
    if (g.family == family && g.sliders == sliders) return &g;
  }
  return nullptr;
}

std::vector<std::string> families(const std::vector<Growth>& growth) {
  std::vector<std::string> names;
  for (const Growth& g : growth) {
    if (std::find(names.begin(), names.end(), g.family) == names.end()) names.push_back(g.family);
  }
  return names;
}

Style style_of(const std::string& family) {
  if (family == dense_family) return {6, 4, true};
  if (family == "driven crank") return {0, 0, false};
  if (family == "undriven crank") return {1, 1, false};
  if (family == "levers in a row") return {2, 2, false};
  return {5, 5, false};
}

double power_below(double x) { return std::pow(10, std::floor(std::log10(x))); }
double power_above(double x) { return std::pow(10, std::ceil(std::log10(x))); }

Chart chart(const std::string& title, const std::string& label) {
  Chart chart;
  chart.title = title;
  chart.x = {"sliders", 1, 64, true};
  chart.y = {label, HUGE_VAL, 0, true};
  return chart;
}

void add_point(Chart& chart, Line& line, const Growth& g, double y) {
  line.points.push_back({static_cast<double>(g.sliders), y});
  chart.y.from = std::min(chart.y.from, power_below(y));
  chart.y.to = std::max(chart.y.to, power_above(y));
}

}  // namespace

std::vector<Growth> measure_growth(int repetitions, const std::function<void(double, const std::string&)>& progress) {
  std::vector<GrowthCase> cases;
  for (const AddGrowth add : growth_sizes()) add(cases);
  const std::size_t mechanisms = cases.size();
  for (std::size_t i = 0; i < mechanisms; ++i) {
    if (cases[i].family == "undriven crank") cases.push_back(dense_work(cases[i].sliders));
  }
  std::vector<Run> runs;
  std::vector<int> solves;
  for (const GrowthCase& one : cases) {
    solves.push_back(one.run());
    if (solves.back() == 0)
      throw std::runtime_error(fmt::format("{} of {}: a step was refused", one.family, one.sliders));
    runs.push_back({fmt::format("{}/{}", one.family, one.sliders), one.run, growth_steps});
  }
  const std::vector<Timing> times = time_in_turns(runs, repetitions, 0.02, progress);
  std::vector<Growth> growth;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const GrowthCase& one = cases[i];
    growth.push_back(
        {one.family, one.sliders, one.parts, one.rows, solves[i], one.bytes, times[i].ns, times[i].low, times[i].high});
  }
  return growth;
}

double exponent(const std::vector<Growth>& growth, const std::string& family, int from, int to) {
  const Growth *a = find(growth, family, from), *b = find(growth, family, to);
  if (a == nullptr || b == nullptr) return std::nan("");
  return std::log(b->ns / a->ns) / std::log(static_cast<double>(to) / from);
}

Chart growth_chart(const std::vector<Growth>& growth) {
  Chart chart = charts::chart("Growth: time", "ns for an rk4 step");
  chart.subtitle = "one contact a slider; in brackets the exponent from 8 sliders to the last";
  for (const std::string& family : families(growth)) {
    Line line{family, style_of(family), {}, {}};
    int last = 0;
    for (const Growth& g : growth) {
      if (g.family != family) continue;
      add_point(chart, line, g, g.ns);
      last = g.sliders;
    }
    const double slope = last > 8 ? exponent(growth, family, 8, last) : std::nan("");
    if (!std::isnan(slope)) line.name += fmt::format(" ({:.2f})", slope);
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

Chart memory_chart(const std::vector<Growth>& growth) {
  Chart chart = charts::chart("Growth: memory", "bytes, in room for exactly so many sliders");
  chart.subtitle = "run-time scene, undriven crank";
  const auto add = [&](const char* name, int colour, auto bytes) {
    Line line{name, {colour, colour, false}, {}, {}};
    for (const Growth& g : growth) {
      if (g.family == "undriven crank") add_point(chart, line, g, static_cast<double>(bytes(g.bytes)));
    }
    chart.lines.push_back(std::move(line));
  };
  add("stack of a step", 0, [](const Bytes& b) { return b.stack; });
  add("tables", 1, [](const Bytes& b) { return b.tables; });
  add("scene", 2, [](const Bytes& b) { return b.scene; });
  add("state", 3, [](const Bytes& b) { return b.state; });
  return chart;
}

io::Json document(const std::vector<Growth>& growth) {
  io::Json json{{"format", io::json_format}, {"dt", growth_dt}, {"steps", growth_steps}};
  json["measured"] = io::Json::array();
  for (const Growth& g : growth) {
    io::Json one{{"family", g.family},
                 {"sliders", g.sliders},
                 {"ns_per_step", {{"median", g.ns}, {"least", g.low}, {"most", g.high}}}};
    if (g.family != dense_family) {
      one["parts"] = g.parts;
      one["rows_of_largest_part"] = g.rows;
      one["solves_max"] = g.solves;
      one["bytes"] = {
          {"scene", g.bytes.scene}, {"tables", g.bytes.tables}, {"state", g.bytes.state}, {"stack", g.bytes.stack}};
    }
    json["measured"].push_back(std::move(one));
  }
  for (const std::string& family : families(growth)) {
    io::Json& slopes = json["exponents"][family];
    int last = 0;
    for (const Growth& g : growth) {
      if (g.family != family) continue;
      if (last > 0) slopes[fmt::format("{} to {}", last, g.sliders)] = exponent(growth, family, last, g.sliders);
      last = g.sliders;
    }
    if (last > 8) slopes[fmt::format("8 to {}", last)] = exponent(growth, family, 8, last);
  }
  for (const Growth& g : growth) {
    const Growth* dense = find(growth, dense_family, g.sliders);
    if (g.sliders > 1 && g.rows == g.sliders && g.family != dense_family && dense != nullptr)
      json["times_dense"][g.family][std::to_string(g.sliders)] = g.ns / dense->ns;
  }
  return json;
}

}  // namespace slideway::charts
