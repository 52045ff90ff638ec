// Ten million steps: drift off the constraints, and what the balance of energy misses, against the number of steps.
// Judge of the position: the closed form of the crank-rocker.
#include <cmath>
#include <memory>

#include "short_run.hpp"

namespace slideway::charts {
namespace {

struct Run {
  Method method;
  double dt;
  Style style;
};
const Run runs[] = {{Method::rk4, 1e-3, {0, 0, false}},
                    {Method::rk4_located, 1e-3, {2, 2, false}},
                    {Method::moreau, 1e-3, {4, 3, false}}};

/// A sum that keeps what rounding takes from it (Kahan).
class Sum {
 public:
  void add(double x) {
    const double y = x - lost_, next = value_ + y;
    lost_ = (next - value_) - y;
    value_ = next;
  }
  double value() const { return value_; }

 private:
  double value_ = 0, lost_ = 0;
};

/// Of the rocker, whose slot the crank's tip is in: O2 is 1 m above O1, the crank 1/2 m long and at the angle 3 t.
double error_of_rocker(const io::RunStepper::State& state) {
  const double crank = 3 * state.time(), th = std::atan2(1 + 0.5 * std::sin(crank), 0.5 * std::cos(crank));
  return std::fabs(std::remainder(state.q[0] - th, 2 * std::acos(-1.0)));
}

struct Sample {
  long steps;
  double drift, energy, error;
};

std::vector<Sample> measure(const io::RunStepper& stepper, double dt, long most,
                            const std::function<void(double)>& progress, Status& status) {
  std::vector<Sample> samples;
  auto state = stepper.start();
  const double first = stepper.kinetic_energy(state) + stepper.potential_energy(state);
  Sum work, dissipated, constraint;
  double drift = 0, energy = 0, error = 0, in_play = 0, next = 10;
  for (long k = 1; k <= most; ++k) {
    const Report report = stepper.step(state, dt);
    status = report.status;
    if (status != Status::ok) break;
    work.add(report.energy.work);
    dissipated.add(report.energy.dissipated);
    constraint.add(report.energy.constraint_work);
    drift = std::fmax(drift, report.drift_position);
    const double kinetic = stepper.kinetic_energy(state), now = kinetic + stepper.potential_energy(state);
    in_play = std::fmax(in_play, kinetic + std::fabs(work.value()));
    energy = std::fmax(energy, std::fabs(now - first - work.value() + dissipated.value() - constraint.value()));
    error = std::fmax(error, error_of_rocker(state));
    if (static_cast<double>(k) + 0.5 < next && k != most) continue;
    samples.push_back({k, drift, energy / in_play, error});
    next *= std::pow(10, 0.25);
    progress(static_cast<double>(k) / static_cast<double>(most));
  }
  return samples;
}

}  // namespace

AtlasMap draw_long_run(const AtlasOptions& options) {
  AtlasMap map = begin_map("long_run");
  map.document.erase("maps");
  const long most = options.quick ? 10'000 : 10'000'000;
  const Axis steps{"steps of 1 ms", 10, static_cast<double>(most), true};
  Chart drift{"Crank-rocker, a long run: drift",
              "largest until then",
              steps,
              {"off the constraints, m", 1e-15, 1e-1, true},
              {},
              {}};
  Chart energy{"Crank-rocker, a long run: energy",
               "largest until then",
               steps,
               {"missing energy, of the energy in play", 1e-15, 1e-1, true},
               {},
               {}};
  Chart error{"Crank-rocker, a long run: position",
              "largest until then, against the closed form",
              steps,
              {"error of the rocker, rad", 1e-15, 1e-1, true},
              {},
              {}};
  io::Json measured = io::Json::array();
  for (const Run& run : runs) {
    const auto stepper = std::make_unique<io::RunStepper>(options.scene("crank_rocker"));
    stepper->method = run.method;
    Status status = Status::ok;
    const auto samples = measure(
        *stepper, run.dt, most, [&](double part) { options.progress(part, name(run.method)); }, status);
    Line lines[3];
    for (Line& line : lines) line = {name(run.method), run.style, {}, {}};
    io::Json points = io::Json::array();
    for (const Sample& s : samples) {
      const double x = static_cast<double>(s.steps);
      const double values[3] = {s.drift, s.energy, s.error};
      for (int i = 0; i < 3; ++i) {
        if (values[i] > 0) lines[i].points.push_back({x, values[i]});
      }
      points.push_back({{"steps", s.steps}, {"drift", s.drift}, {"energy", s.energy}, {"error", s.error}});
    }
    drift.lines.push_back(lines[0]);
    energy.lines.push_back(lines[1]);
    error.lines.push_back(lines[2]);
    measured.push_back(
        {{"method", name(run.method)}, {"dt", run.dt}, {"status", name(status)}, {"points", std::move(points)}});
  }
  map.document["scene"] = "crank_rocker";
  map.document["runs"] = std::move(measured);
  map.figures = {{"long_run_drift", drift}, {"long_run_energy", energy}, {"long_run_position", error}};
  return map;
}

}  // namespace slideway::charts
