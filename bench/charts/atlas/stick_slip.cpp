// A block on a moving belt, held by a spring: step size against the belt's speed. Fast belts leave short phases of
// sticking, which long steps miss. Judge: the closed form.
//
// With w^2 = k / m, A = (mu_static - mu) m g / k: the block, at rest on the belt, leaves at x = mu_static m g / k,
// slips for (2 pi - 2 atan(A w / V)) / w and sticks again for 2 A / V.
#include <algorithm>
#include <cmath>

#include "short_run.hpp"

namespace slideway::charts {
namespace {

using State = io::RunStepper::State;

constexpr int cycles = 4;  ///< of sticking and slipping, that a run spans

struct Belt {
  double speed, frequency, centre, amplitude;  ///< m/s, 1/s, and of the slipping oscillation m
  double slip, stick, first;                   ///< s: a slipping phase, a sticking one, the first break-away
  double period() const { return slip + stick; }
  /// In the middle of a sticking phase, so that no event is near.
  double duration() const { return first + cycles * period() - stick / 2; }
  double position(double t) const;
};

Belt belt_of(const RunScene& scene, double speed) {
  const double m = scene.body[1].mass, k = scene.spring[0].stiffness, g = -scene.gravity.y;
  const Guide& guide = scene.guide[0];
  Belt b{};
  b.speed = speed;
  b.frequency = std::sqrt(k / m);
  b.centre = guide.mu * m * g / k;
  b.amplitude = (guide.mu_static - guide.mu) * m * g / k;
  b.slip = (2 * std::acos(-1.0) - 2 * std::atan(b.amplitude * b.frequency / speed)) / b.frequency;
  b.stick = 2 * b.amplitude / speed;
  b.first = (b.centre + b.amplitude) / speed;
  return b;
}

double Belt::position(double t) const {
  if (t < first) return speed * t;
  const double in_period = std::fmod(t - first, period());
  if (in_period >= slip) return centre - amplitude + speed * (in_period - slip);
  const double phase = frequency * in_period;
  return centre + amplitude * std::cos(phase) + speed / frequency * std::sin(phase);
}

RunScene at_speed(RunScene scene, double speed) {
  scene.drive[0].c[1] = speed;
  for (int i = 0; i < 2; ++i) scene.body[i].v[0] = speed;
  return scene;
}

/// What a run is like at its end: phases of sticking that it began, the first included, and where the block is.
struct Seen {
  Status status = Status::ok;
  int sticks = 0;
  double position = 0;
  bool said = false;  ///< events that were stepped over are counted in the reports
};

/// Right: every phase of sticking, and the block off by no more than a tenth of what it moves by.
Cell judge(const Seen& seen, const Belt& belt) {
  if (seen.status != Status::ok) return Cell::refused_wrongly;
  const double travel = belt.amplitude + std::hypot(belt.amplitude, belt.speed / belt.frequency);
  const bool near = std::fabs(seen.position - belt.position(belt.duration())) <= 0.1 * travel;
  if (seen.sticks == cycles + 1 && near) return Cell::right;
  return seen.said ? Cell::warned : Cell::wrong;
}

Seen run(const io::RunStepper& stepper, const Belt& belt, double dt) {
  Seen seen;
  State state = stepper.start();
  const long steps = std::max(1L, std::lround(belt.duration() / dt));
  bool rests = true;
  seen.sticks = 1;
  for (long k = 0; k < steps; ++k) {
    const Report report = stepper.step(state, belt.duration() / static_cast<double>(steps));
    seen.status = report.status;
    if (report.status != Status::ok) return seen;
    seen.said = seen.said || report.unlocated_events > 0;
    for (int e = 0; e < report.events; ++e) seen.sticks += report.event[e].kind == EventKind::stick ? 1 : 0;
    if (!is_located(stepper.method)) {
      seen.sticks += !rests && state.mode[0] == 0 ? 1 : 0;
      rests = state.mode[0] == 0;
    }
  }
  seen.position = state.q[1];
  return seen;
}

/// rk4 with F = -mu(v) m g tanh(v / width), mu falling from mu_static to mu over ten widths, as is usual: it sticks
/// while it is slower than five widths.
Seen run_regularised(const RunScene& scene, const Belt& belt, double dt) {
  const double width = 1e-2 * belt.speed, g = -scene.gravity.y;
  const Guide& guide = scene.guide[0];
  const auto acceleration = [&](double x, double v) {
    const double slip = v - belt.speed, size = std::fabs(slip) / width;
    const double mu = guide.mu + (guide.mu_static - guide.mu) * std::exp(-size / 10);
    return -belt.frequency * belt.frequency * x - mu * g * std::tanh(slip / width);
  };
  Seen seen;
  double x = 0, v = belt.speed;
  bool rests = true;
  seen.sticks = 1;
  const long steps = std::max(1L, std::lround(belt.duration() / dt));
  const double h = belt.duration() / static_cast<double>(steps);
  for (long k = 0; k < steps; ++k) {
    const double a1 = acceleration(x, v), v2 = v + h / 2 * a1;
    const double a2 = acceleration(x + h / 2 * v, v2), v3 = v + h / 2 * a2;
    const double a3 = acceleration(x + h / 2 * v2, v3), v4 = v + h * a3;
    const double a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    const bool now = std::fabs(v - belt.speed) < 5 * width;
    seen.sticks += now && !rests ? 1 : 0;
    rests = now;
  }
  seen.position = x;
  if (!std::isfinite(x)) seen.status = Status::inaccurate;
  return seen;
}

}  // namespace

AtlasMap draw_stick_slip(const AtlasOptions& options) {
  constexpr Method integrating[] = {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located,
                                    Method::moreau};
  AtlasMap map = begin_map("stick_slip");
  const RunScene given = options.scene("belt");
  const double finest = options.quick ? 1e-2 : 1e-3;
  const Grid grid{{"step, s", finest, 10, true},
                  {"speed of the belt, m/s", 0.05, 1, true},
                  options.quick ? 12 : 40,
                  options.quick ? 9 : 24};
  Line stick{"a step as long as a sticking phase", {6, -1, false}, {}, {}};
  Line slip{"as long as a slipping phase", {6, -1, true}, {}, {}};
  for (const double speed : decades(-2, 0, 10)) {
    const Belt belt = belt_of(given, speed);
    stick.points.push_back({belt.stick, speed});
    slip.points.push_back({belt.slip, speed});
  }
  const auto draw = [&](const std::string& name, const std::string& who, const auto& run_of) {
    add_cells(map, {name, who, "Block on a belt: is every phase of sticking there?", {stick, slip}}, grid,
              judge_cells(grid, [&](double dt, double speed) {
                const Belt belt = belt_of(given, speed);
                return judge(run_of(at_speed(given, speed), belt, dt), belt);
              }));
  };
  for (const Method method : integrating) {
    draw(name(method), std::string("slideway ") + name(method),
         [&](const RunScene& scene, const Belt& belt, double dt) {
           io::RunStepper stepper(scene);
           stepper.method = method;
           stepper.gains = {1 / dt, 0.25 / (dt * dt)};  // stable for every method at this step
           return run(stepper, belt, dt);
         });
  }
  draw("regularised", "rk4 with tanh friction", run_regularised);
  return map;
}

}  // namespace slideway::charts
