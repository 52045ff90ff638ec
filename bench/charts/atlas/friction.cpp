// Coefficient of friction against geometry, where Coulomb's law has no, one or several answers. Judge: the oracle, by
// all modes in 50 digits, at the state where a run ends or is refused.
#include <cmath>

#include "exact_instant.hpp"
#include "exact_jump.hpp"
#include "naive.hpp"
#include "short_run.hpp"

namespace slideway::charts {
namespace {

constexpr Method integrating[] = {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located,
                                  Method::moreau};
constexpr double dt = 1e-4;
constexpr long steps = 10;

using MakeScene = std::function<RunScene(double mu, double geometry)>;

/// Of velocities and impulses: the last step that was made, or the one that was refused.
Cell judge_moreau(const io::RunStepper& stepper) {
  State state = stepper.start(), before = state;
  Report report;
  for (long k = 0; k < steps && report.status == Status::ok; ++k) {
    before = state;
    report = stepper.step(state, dt);
  }
  const ExactJump exact(stepper.source.scene, before, dt);
  return report.status == Status::ok ? exact.judge(state, report.drift_position) : exact.refused(report.status);
}

/// A refusal at a state, for something that is so there or before the next step's end.
Cell judge_refusal(io::RunStepper stepper, State state, Status status, const ExactInstant& there) {
  const Cell cell = there.refused(status);
  stepper.method = Method::rk4_located;
  if (cell != Cell::refused_wrongly || stepper.step(state, dt).status != Status::ok) return cell;
  return ExactInstant(stepper.source.scene, state).refused(status);
}

Cell judge_method(io::RunStepper stepper, Method method, const ExactInstant& at_start) {
  stepper.method = method;
  if (method == Method::moreau) return judge_moreau(stepper);
  const State from = stepper.start();
  const ShortRun run = short_run(stepper, from, dt, steps);
  const auto& scene = stepper.source.scene;
  if (run.status != Status::ok) {
    if (run.steps == 0) return judge_refusal(stepper, from, run.status, at_start);
    return judge_refusal(stepper, run.state, run.status, ExactInstant(scene, run.state));
  }
  if (!keeps_its_promise(stepper, from, dt, run)) return Cell::wrong;
  return ExactInstant(scene, run.state).judge(stepper);
}

struct Geometry {
  std::string name, title;
  Grid grid;
  MakeScene scene;
  std::vector<Line> lines;
  std::vector<Note> notes;
};

void draw(const Geometry& geometry, const AtlasOptions& options, double part, AtlasMap& map) {
  constexpr int peers = 3;
  static const char* const peer_names[peers] = {"fixed_point", "gauss_seidel", "regularised"};
  static const char* const peer_titles[peers] = {"fixed point on the friction's normal force",
                                                 "projected Gauss-Seidel, 50 sweeps",
                                                 "tanh friction of the last step's normal force"};
  std::vector<Cell> cells[std::size(integrating) + peers];
  int done = 0;
  judge_cells(geometry.grid, [&](double mu, double shape) {
    options.progress(part + 0.5 * done++ / (geometry.grid.columns * geometry.grid.rows), geometry.name);
    const RunScene scene = geometry.scene(mu, shape);
    const io::RunStepper stepper(scene);
    const ExactInstant exact(scene, stepper.start());
    std::size_t k = 0;
    for (const Method method : integrating) cells[k++].push_back(judge_method(stepper, method, exact));
    ContactProblem problem;
    const bool stated = exact.problem(problem);
    constexpr double tolerance = 1e-3;  // three digits are enough
    cells[k++].push_back(exact.judge(stated ? fixed_point(problem) : std::vector<double>{}, tolerance));
    cells[k++].push_back(exact.judge(stated ? projected_gauss_seidel(problem) : std::vector<double>{}, tolerance));
    cells[k++].push_back(exact.judge(stated ? lagged_normal_force(problem, 50) : std::vector<double>{}, tolerance));
    return Cell::right;
  });
  std::size_t k = 0;
  for (const Method method : integrating) {
    const std::string who = name(method);
    add_cells(map, {geometry.name + "_" + who, "slideway " + who, geometry.title, geometry.lines, geometry.notes},
              geometry.grid, cells[k++]);
  }
  for (int peer = 0; peer < peers; ++peer) {
    add_cells(
        map,
        {geometry.name + "_" + peer_names[peer], peer_titles[peer], geometry.title, geometry.lines, geometry.notes},
        geometry.grid, cells[k++]);
  }
}

/// The block on two feet, centre of mass at height c over the way; a half of the feet's distance, M the moment. With
/// W = 10 N: one answer for mu c < a, else two while mu c < a + M / W, none beyond.
Geometry overhung(const AtlasOptions& options) {
  const RunScene given = options.scene("overhung_slider");
  const double a = given.guide[0].contact[1].x, weight = -given.gravity.y * given.body[0].mass;
  const double moment = given.load[0].torque;
  // Slipping forward, D = N2 - N1 solves a D = mu c Lambda - M with Lambda = max(W, |D|). |D| <= W needs mu c W <= M +
  // a W; D > W needs a < mu c and M / (mu c - a) > W, the same limit: there both answers meet, and beyond is none.
  const double unique = a, any = a + moment / weight;
  Geometry g{
      "overhung",
      "Overhung slider: one answer, two, none",
      {{"coefficient of friction", 0, 1}, {"overhang, c / a", 0, 6}, options.quick ? 12 : 50, options.quick ? 8 : 40},
      [given, a](double mu, double shape) {
        RunScene scene = given;
        scene.guide[0].mu = scene.guide[0].mu_static = mu;
        scene.body[0].com.y = shape * a;
        return scene;
      },
      {},
      {}};
  Line w{"one answer below: mu c = a", {6, -1, false}, {}, {}}, none{"none above", {6, -1, true}, {}, {}};
  for (int k = 1; k <= 100; ++k) {
    const double mu = k / 100.0;
    w.points.push_back({mu, unique / (a * mu)});
    none.points.push_back({mu, any / (a * mu)});
  }
  g.lines = {w, none};
  return g;
}

/// The rod on two guides at an angle gamma, in the symmetric pose, pushed along itself by 10 N.
Geometry rod(const AtlasOptions& options) {
  const RunScene given = options.scene("rod_on_two_guides");
  Geometry g{"rod",
             "Rod on two guides: one answer, or not",
             {{"coefficient of friction", 0, 1},
              {"angle between the guides, degrees", 5, 85},
              options.quick ? 12 : 50,
              options.quick ? 8 : 40},
             [given](double mu, double degrees) {
               RunScene scene = given;
               const double gamma = degrees * std::acos(-1.0) / 180, th = std::acos(0.0) + gamma / 2, rate = 0.1;
               const double c = std::cos(th), s = std::sin(th), from_corner = 1 / std::sin(gamma / 2);
               const double along = 2 * rate * (s + c / std::tan(gamma));  // of the end on the x axis
               Body& body = scene.body[0];
               body.q[0] = from_corner + c;
               body.q[1] = s;
               body.q[2] = th;
               body.v[0] = along - rate * s;
               body.v[1] = rate * c;
               body.v[2] = rate;
               scene.guide[1].direction = scene.guide[1].tangent = {std::cos(gamma), std::sin(gamma)};
               scene.load[0].force = {-10 * c, -10 * s};
               for (int k = 0; k < 2; ++k) scene.guide[k].mu = scene.guide[k].mu_static = mu;
               return scene;
             },
             {},
             {}};
  Line w{"one answer above: mu = tan(gamma / 2)", {6, -1, false}, {}, {}};
  for (int k = 5; k <= 85; ++k) w.points.push_back({std::tan(k * std::acos(-1.0) / 360), static_cast<double>(k)});
  Line second{"one answer right of it, by the oracle", {6, -1, true}, {}, {}};
  for (int row = 0; row < g.grid.rows; ++row) {
    const double degrees = g.grid.up(row);
    const auto unique = [&](double mu) {
      const RunScene scene = g.scene(mu, degrees);
      return ExactInstant(scene, io::RunStepper(scene).start()).is_unique();
    };
    double low = std::tan(degrees * std::acos(-1.0) / 360) + 0.01, high = 1.2;
    if (unique(low) || !unique(high)) continue;
    for (int k = 0; k < 12; ++k) {
      const double middle = (low + high) / 2;
      (unique(middle) ? high : low) = middle;
    }
    second.points.push_back({high, degrees});
  }
  g.lines = {w, second};
  return g;
}

}  // namespace

AtlasMap draw_friction(const AtlasOptions& options) {
  AtlasMap map = begin_map("friction");
  draw(overhung(options), options, 0, map);
  draw(rod(options), options, 0.5, map);
  return map;
}

}  // namespace slideway::charts
