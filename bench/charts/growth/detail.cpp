#include "detail.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "timing.hpp"

namespace slideway::charts {
namespace {

/// max |a - b| / max |b|
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    apart = std::max(apart, std::fabs(a[i] - b[i]));
    size = std::max(size, std::fabs(b[i]));
  }
  return size > 0 ? apart / size : apart;
}

constexpr double least_shown = 1e-16;

double power_below(double x) { return std::pow(10, std::floor(std::log10(x))); }
double power_above(double x) { return std::pow(10, std::ceil(std::log10(x))); }

}  // namespace

double Detail::largest() const { return std::max({place, normal, torque}); }

std::vector<Detail> measure_detail(const Machine& machine, int repetitions,
                                   const std::function<void(double, const std::string&)>& progress) {
  const Answer right = machine.most_detailed();
  std::vector<Run> runs;
  for (const Model& model : machine.models) runs.push_back({model.name, model.run, static_cast<double>(machine.steps)});
  const std::vector<Timing> times = time_in_turns(runs, repetitions, 0.02, progress);
  std::vector<Detail> details;
  for (std::size_t i = 0; i < machine.models.size(); ++i) {
    const Model& model = machine.models[i];
    const Answer answer = model.answer();
    details.push_back({model.name, model.style, times[i].ns, times[i].low, times[i].high,
                       difference(answer.place, right.place), difference(answer.normal, right.normal),
                       difference(answer.torque, right.torque)});
  }
  return details;
}

Chart detail_chart(const Machine& machine, const std::vector<Detail>& details) {
  Chart chart;
  chart.title = machine.name + ": what detail costs";
  chart.subtitle = fmt::format("{} steps of {:g} s; friction unless said otherwise", machine.steps, machine.dt);
  double cheapest = HUGE_VAL, dearest = 0;
  char letter = 'a';
  for (const Detail& d : details) {
    const double shown = std::max(d.largest(), least_shown);
    chart.lines.push_back({fmt::format("{}  {}", letter, d.model), d.style, {{d.ns, shown}}, {{d.low, d.high}}});
    // Every other one below its marker, so that neighbours' letters do not meet.
    const bool below = (letter - 'a') % 2 == 1;
    chart.notes.push_back({{d.ns * 1.05, below ? shown / 10 : shown * 1.6}, std::string(1, letter++)});
    cheapest = std::min(cheapest, d.low);
    dearest = std::max(dearest, d.high);
  }
  chart.x = {"ns a step", power_below(cheapest), power_above(dearest), true};
  chart.y = {machine.driven ? "difference of places, forces, torque" : "difference of places and forces",
             least_shown / 100, 10, true};
  return chart;
}

io::Json document(const Machine& machine, const std::vector<Detail>& details) {
  io::Json json{{"scene", machine.name}, {"steps", machine.steps}, {"dt", machine.dt}};
  for (const Detail& d : details) {
    io::Json one{{"model", d.model},
                 {"ns_per_step", {{"median", d.ns}, {"least", d.low}, {"most", d.high}}},
                 {"difference", {{"place", d.place}, {"normal", d.normal}}}};
    if (machine.driven) one["difference"]["torque"] = d.torque;
    json["models"].push_back(std::move(one));
  }
  return json;
}

}  // namespace slideway::charts
