// Baumgarte's gains against the step size: does a disturbance of the constraints decay? Axes: h sqrt(beta), and the
// damping ratio alpha / (2 sqrt(beta)). The step is short beside the motion (a thousandth of a turn and less), so that
// the method's map of e'' + alpha e' + beta e = 0 decides alone; the boundary measured by bisection is held against it,
// without friction, since located methods cut a step where friction's functions vary.
//
// A cell is a run from the scene's own start. Within the boundary it must be right: off by at most ten times what the
// order promises (twice what a half or a third of the step changes), or what the report itself says of the drift.
// Beyond, a refusal is right, whatever its reason: of stages that are off the constraints any may be true. The truth is
// dop853_located at gains of h sqrt(beta) = 1/4.
#include <algorithm>
#include <cmath>
#include <complex>
#include <slideway/oracle/drift.hpp>

#include "short_run.hpp"

namespace slideway::charts {
namespace {

using State = io::RunStepper::State;

struct Tested {
  Method method;
  Style style;
};
const Tested tested[] = {{Method::euler, {1, 1, false}},
                         {Method::rk4, {0, 0, false}},
                         {Method::rk4_located, {2, 2, false}},
                         {Method::dop853_located, {3, 3, false}},
                         {Method::moreau, {4, 4, false}}};

struct Case {
  std::string scene;
  double dt;
};
const Case cases[] = {{"crank_rocker", 1e-3}, {"slider_crank", 1e-5}};

io::RunStepper stepper_of(const RunScene& scene, Method method, double h, double z, double damping) {
  io::RunStepper stepper(scene);
  const double w = z / h;
  stepper.method = method;
  stepper.gains = {2 * damping * w, w * w};
  return stepper;
}

/// moreau: Phi_m = Phi + (1 - theta) h Phi', Phi'+ = -c Phi_m, Phi+ = (1 - theta h c) Phi_m with c = beta / alpha. One
/// eigenvalue is 0, the other 1 - h c.
double moreau_radius(double z, double damping) { return std::fabs(1 - z / (2 * damping)); }

/// Coefficients c_k = b' A^(k-1) 1 of a Runge-Kutta method's stability polynomial, from the oracle's tableau.
std::vector<double> stability_polynomial(oracle::Scheme scheme) {
  using oracle::Real;
  const auto method = oracle::runge_kutta<Real>(scheme);
  std::vector<double> c = {1};
  std::vector<Real> power(method.b.size(), Real(1));
  for (std::size_t k = 0; k < method.b.size(); ++k) {
    Real sum(0);
    for (std::size_t i = 0; i < power.size(); ++i) sum += method.b[i] * power[i];
    c.push_back(static_cast<double>(sum));
    std::vector<Real> next(power.size(), Real(0));
    for (std::size_t i = 0; i < power.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) next[i] += method.a[i][j] * power[j];
    }
    power = next;
  }
  return c;
}

/// Of a method's map of (Phi, Phi') at h = 1: its spectral radius.
double radius(Method method, double z, double damping) {
  if (method == Method::moreau) return moreau_radius(z, damping);
  if (method == Method::euler) {
    return oracle::spectral_radius<double>(oracle::semi_implicit_map<double>(1, 2 * damping * z, z * z));
  }
  static const auto of_rk4 = stability_polynomial(oracle::Scheme::rk4),
                    of_dop853 = stability_polynomial(oracle::Scheme::dop853_located);
  const auto& c = method == Method::dop853_located ? of_dop853 : of_rk4;
  double most = 0;
  for (const double side : {1.0, -1.0}) {
    const std::complex<double> root = z * (-damping + side * std::sqrt(std::complex<double>(damping * damping - 1)));
    std::complex<double> value = 0;
    for (std::size_t k = c.size(); k-- > 0;) value = value * root + c[k];
    most = std::max(most, std::abs(value));
  }
  return most;
}

/// The first z at which `stable` ends: a search in steps of 2 %, then bisection.
double first_boundary(const std::function<bool(double)>& stable, double from) {
  double low = from, high = from;
  while (high < 30 && stable(high)) {
    low = high;
    high *= 1.02;
  }
  for (int k = 0; k < 12; ++k) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Phi of all contacts, and h Phi'.
std::vector<double> constraint_errors(const io::RunStepper& stepper, const State& state, double h) {
  const double none_prescribed[io::RunSize::coordinates] = {};
  Kinematics<io::RunSize> k;
  kinematics(stepper.source, state.q, state.v, none_prescribed, k);
  std::vector<double> errors;
  for (int g = 0; g < stepper.source.scene.guides; ++g) {
    Sliding s;
    sliding(stepper.source, k, g, s);
    for (int c = 0; c < stepper.source.scene.guide[g].contacts; ++c) {
      errors.push_back(s.Phi[c]);
      errors.push_back(h * s.Phi_rate[c]);
    }
  }
  return errors;
}

/// Does a disturbance of Phi decay? Two runs, one disturbed, so that the method's own defects cancel; the largest
/// difference in the last quarter of them is compared with that in the first eighth. A refusal: no. The disturbance is
/// so small that beta Phi is far below the motion's accelerations: no contact force changes its sign for it.
bool decays(const io::RunStepper& stepper, double h, long steps) {
  State plain = stepper.start(), disturbed = plain;
  const auto& table = stepper.source.tables;
  const double size = 1e-10 * table.length;
  for (int j = 0; j < table.coordinates; ++j) {
    if (table.free_of[j] != none) disturbed.q[j] += j % 2 == 0 ? size : -size;
  }
  double early = 0, late = 0;
  for (long k = 0; k < steps; ++k) {
    if (stepper.step(plain, h).status != Status::ok || stepper.step(disturbed, h).status != Status::ok) return false;
    const auto a = constraint_errors(stepper, plain, h), b = constraint_errors(stepper, disturbed, h);
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
    if (k < steps / 8) early = std::max(early, most);
    if (k >= 3 * steps / 4) late = std::max(late, most);
  }
  return late < early;
}

struct Boundaries {
  io::Json json = io::Json::array();
  double worst = 0;  ///< |measured / theory - 1|
};

void measure(const Case& of, const RunScene& scene, const Tested& one, const AtlasOptions& options, Chart& chart,
             Boundaries& found) {
  const long steps = options.quick ? 400 : 1000;
  const std::vector<double> ratios =
      options.quick ? std::vector<double>{1} : std::vector<double>{0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 3};
  for (const double damping : ratios) {
    const double theory = first_boundary([&](double z) { return radius(one.method, z, damping) < 1; }, 0.05);
    const double measured = first_boundary(
        [&](double z) { return decays(stepper_of(scene, one.method, of.dt, z, damping), of.dt, steps); }, 0.6 * theory);
    found.json.push_back({{"scene", of.scene},
                          {"method", name(one.method)},
                          {"damping_ratio", damping},
                          {"theory", theory},
                          {"measured", measured},
                          {"ratio", measured / theory}});
    found.worst = std::max(found.worst, std::fabs(measured / theory - 1));
    for (Line& line : chart.lines) {
      if (line.name == name(one.method)) line.points.push_back({damping, measured});
    }
  }
}

Line theory_line(Method method, bool dashed, int colour, double most) {
  Line line{"", {colour, -1, dashed}, {}, {}};
  for (double damping = 0.05; damping <= 3.1; damping *= 1.03) {
    const double z = first_boundary([&](double at) { return radius(method, at, damping) < 1; }, 0.02);
    if (z < most) line.points.push_back({damping, z});
  }
  return line;
}

void draw_cells(const Case& of, const RunScene& scene, Method method, const AtlasOptions& options, AtlasMap& map) {
  const long steps = options.quick ? 50 : 200;
  const Grid grid{{"h sqrt(beta)", 0, 8},
                  {"damping ratio, alpha / (2 sqrt(beta))", 0, 3},
                  options.quick ? 10 : 48,
                  options.quick ? 6 : 32};
  io::RunStepper judge = stepper_of(scene, Method::dop853_located, of.dt, 0.25, 1);
  const ShortRun truth = short_run(judge, judge.start(), of.dt, steps);
  const auto cells = judge_cells(grid, [&](double z, double damping) {
    const io::RunStepper stepper = stepper_of(scene, method, of.dt, z, damping);
    const bool stable = radius(method, z, damping) < 1;
    const ShortRun run = short_run(stepper, stepper.start(), of.dt, steps);
    if (run.status != Status::ok) return stable ? Cell::refused_wrongly : Cell::refused_rightly;
    io::RunStepper::Reaction r;
    const double said = std::max(run.drift, stepper.reaction(run.state, {}, r).drift_position);
    const ShortRun half = short_run(stepper, stepper.start(), of.dt / 2, 2 * steps);
    const ShortRun third = short_run(stepper, stepper.start(), of.dt / 3, 3 * steps);
    const double change = std::max(distance(stepper, run.state, half.state), distance(stepper, run.state, third.state));
    const double promise = std::max(2 * change, said) + 1e-13 * judge.source.tables.length;
    return distance(stepper, run.state, truth.state) <= 10 * promise ? Cell::right : Cell::wrong;
  });
  Line line = theory_line(method, false, 6, 8);
  line.name = "stable on the left, in theory";
  for (auto& point : line.points) std::swap(point[0], point[1]);
  const std::string who = name(method);
  add_cells(map, {of.scene + "_" + who, "slideway " + who, "Baumgarte's gains, " + of.scene, {line}, {}}, grid, cells);
}

}  // namespace

AtlasMap draw_baumgarte(const AtlasOptions& options) {
  AtlasMap map = begin_map("baumgarte");
  Boundaries boundaries;
  for (const Case& of : cases) {
    const RunScene scene = options.scene(of.scene);
    RunScene smooth = scene;
    for (int g = 0; g < smooth.guides; ++g) smooth.guide[g].mu = smooth.guide[g].mu_static = 0;
    Chart chart{"Largest stable gains, " + of.scene,
                "no friction; lines: theory, markers: measured",
                {"damping ratio, alpha / (2 sqrt(beta))", 0, 3},
                {"largest h sqrt(beta)", 0, 10},
                {},
                {}};
    for (const Tested& one : tested) {
      if (one.method != Method::rk4_located) {
        chart.lines.push_back(theory_line(one.method, false, one.style.colour, 10));
      }
      chart.lines.push_back({name(one.method), one.style, {}, {}});
      measure(of, smooth, one, options, chart, boundaries);
      draw_cells(of, scene, one.method, options, map);
    }
    map.figures.push_back({"baumgarte_" + of.scene, chart});
  }
  map.document["boundaries"] = boundaries.json;
  map.document["largest_deviation"] = boundaries.worst;
  return map;
}

}  // namespace slideway::charts
