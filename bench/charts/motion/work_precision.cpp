#include "work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace slideway::charts {
namespace {

/// Families in the order in which they were added.
std::vector<std::string> families(const WorkPrecision& wp) {
  std::vector<std::string> names;
  for (const auto& contender : wp.contenders) {
    if (std::find(names.begin(), names.end(), contender->family) == names.end()) names.push_back(contender->family);
  }
  return names;
}

bool is_run_time(const std::string& family) { return family.ends_with(", run time"); }

/// Methods keep their colours from chart to chart; peers are dashed.
Style style_of(const std::string& family) {
  for (const Method method : methods) {
    if (family != name(method)) continue;
    const int place = static_cast<int>(method);
    return {place, place, false};
  }
  const bool modes = family.find("modes") != std::string::npos, lent = family.ends_with("lent equations");
  return {modes ? 7 : 6, lent ? 5 : 4, true};
}

/// The cheapest at every error: cost against error, cheapest first.
template <class Cost, class Error>
std::vector<const Measured*> front(const WorkPrecision& wp, const std::string& family, Cost cost, Error error) {
  std::vector<const Measured*> all;
  for (const Measured& m : wp.measured) {
    if (m.contender->family == family && m.failure.empty() && m.ns_low > 0) all.push_back(&m);
  }
  std::sort(all.begin(), all.end(), [&](const Measured* a, const Measured* b) { return cost(*a) < cost(*b); });
  std::vector<const Measured*> best;
  for (const Measured* m : all) {
    if (best.empty() || error(*m) < error(*best.back())) best.push_back(m);
  }
  return best;
}

double power_below(double x) { return std::pow(10, std::floor(std::log10(x))); }
double power_above(double x) { return std::pow(10, std::ceil(std::log10(x))); }

template <class Cost, class Error>
Chart chart(const WorkPrecision& wp, const std::string& what, const std::string& cost_label,
            const std::string& error_label, bool spread, Cost cost, Error error) {
  Chart chart;
  chart.title = fmt::format("{}: {}", wp.scene.name, what);
  const std::size_t events = wp.reference.trajectory.events.size();
  chart.subtitle = fmt::format("{:g} s, {} event{}, error against {:.0f} digits", wp.reference.duration, events,
                               events == 1 ? "" : "s", std::floor(wp.reference.digits));
  double cheapest = HUGE_VAL, dearest = 0;
  for (const std::string& family : families(wp)) {
    if (is_run_time(family)) continue;
    Line line{family, style_of(family), {}, {}};
    for (const Measured* m : front(wp, family, cost, error)) {
      const double shown = std::max(error(*m), 1e-16);
      if (shown > 1) continue;
      line.points.push_back({cost(*m), shown});
      if (spread) line.spread.push_back({m->ns_low, m->ns_high});
      cheapest = std::min(cheapest, cost(*m));
      dearest = std::max(dearest, cost(*m));
    }
    if (!line.points.empty()) chart.lines.push_back(std::move(line));
  }
  chart.x = {cost_label, power_below(cheapest), power_above(dearest), true};
  chart.y = {error_label, 1e-16, 1, true};
  return chart;
}

constexpr auto nanoseconds = [](const Measured& m) { return m.ns; };
constexpr auto of_position = [](const Measured& m) { return m.error; };
constexpr auto of_force = [](const Measured& m) { return m.force_error; };

}  // namespace

bool is_kernel(const Contender& contender) { return contender.setting == "dt"; }

Chart time_chart(const WorkPrecision& wp) {
  return chart(wp, "time", "ns for each simulated second", "error of positions", true, nanoseconds, of_position);
}

Chart evaluations_chart(const WorkPrecision& wp) {
  const auto evaluations = [&](const Measured& m) {
    return static_cast<double>(m.evaluations) / wp.reference.duration;
  };
  return chart(wp, "evaluations", "evaluations for each simulated second", "error of positions", false, evaluations,
               of_position);
}

Chart force_chart(const WorkPrecision& wp) {
  return chart(wp, "contact forces", "ns for each simulated second", "error of contact forces", true, nanoseconds,
               of_force);
}

io::Json document(const WorkPrecision& wp) {
  io::Json json{{"format", io::json_format},
                {"scene", wp.scene.name},
                {"hash", wp.scene.hash},
                {"duration", wp.reference.duration},
                {"reference_digits", std::floor(wp.reference.digits)}};
  io::Json points = io::Json::array();
  for (const Measured& m : wp.measured) {
    io::Json point{{"family", m.contender->family}, {"name", m.contender->name}, {m.contender->setting, m.setting}};
    if (!m.failure.empty()) {
      point["failure"] = m.failure;
    } else {
      point["error"] = m.error;
      point["force_error"] = m.force_error;
      point["evaluations"] = m.evaluations;
      if (m.ns_low > 0) point["ns_per_second"] = {{"median", m.ns}, {"least", m.ns_low}, {"most", m.ns_high}};
    }
    points.push_back(std::move(point));
  }
  json["measured"] = std::move(points);
  io::Json cheapest_by_error = io::Json::array();
  for (int decade = first_decade; decade <= last_decade; ++decade) {
    const double error = std::pow(10, -decade);
    const Measured* ours = cheapest(
        wp.measured, [](const Contender& c) { return is_kernel(c) && !is_run_time(c.family); }, error);
    io::Json row{{"error", error}};
    if (ours != nullptr) {
      row["method"] = ours->contender->family;
      row["stabilised"] = ours->contender->name;
      row["dt"] = ours->setting;
      row["ns_per_second"] = ours->ns;
    }
    io::Json ratios = io::Json::object();
    for (const std::string& family : families(wp)) {
      const Measured* theirs = cheapest(
          wp.measured, [&](const Contender& c) { return !is_kernel(c) && c.family == family; }, error);
      if (theirs == nullptr || ours == nullptr) continue;
      ratios[family] = {
          {"ratio", theirs->ns / ours->ns}, {"name", theirs->contender->name}, {"tolerance", theirs->setting}};
    }
    row["times_dearer"] = std::move(ratios);
    cheapest_by_error.push_back(std::move(row));
  }
  json["cheapest"] = std::move(cheapest_by_error);
  return json;
}

}  // namespace slideway::charts
