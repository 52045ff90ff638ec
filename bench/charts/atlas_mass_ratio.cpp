// Digits that are left of the contact forces of a driven slider-crank as its rod becomes light: by the elimination as
// it is written (M^-1 and two Schur complements, WWZ14 (13)-(19)) and by LU of the whole system, both in Cartesian
// coordinates, and by the kernel's. Judge: the oracle, in 50 digits.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "cartesian.hpp"
#include "exact_instant.hpp"

namespace slideway::charts {
namespace {

/// The Cartesian equations at the scene's start, guides slipping.
struct Equations {
  CartesianEquations of;
  std::vector<double> x, u, acceleration;
  std::vector<GuideFriction> friction;
  std::vector<signed char> sign;
  double t = 0;

  Equations(const RunScene& scene, const State& state)
      : of(scene),
        x(3 * static_cast<std::size_t>(scene.bodies)),
        u(x.size()),
        acceleration(x.size()),
        friction(static_cast<std::size_t>(scene.guides)),
        sign(static_cast<std::size_t>(contacts(scene)), 1),
        t(state.time()) {
    of.from_joints(state.q, state.v, x.data(), u.data());
    for (int g = 0; g < scene.guides; ++g) {
      const double slip = of.slip(g, x.data(), u.data());
      friction[static_cast<std::size_t>(g)].per_force = slip < 0 ? scene.guide[g].mu : -scene.guide[g].mu;
    }
  }
  bool solve(bool follow) {
    return of.accelerate(t, x.data(), u.data(), friction.data(), sign.data(), follow, acceleration.data());
  }
};

/// The whole system by LU with partial pivoting, signs by iteration.
std::vector<double> by_lu(const RunScene& scene, const State& state) {
  Equations e(scene, state);
  std::vector<double> lambda;
  if (!e.solve(false)) return lambda;
  for (int c = 0; c < contacts(scene); ++c) lambda.push_back(e.of.lambda(c));
  return lambda;
}

/// M q'' = h + J_phi' mu + N' lambda + P |lambda| with M^-1 and the Schur complements of drives and joints, then of the
/// contacts, all by inverses, as the equations say; signs by iteration.
std::vector<double> by_inverses(const RunScene& scene, const State& state) {
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  Equations e(scene, state);
  if (!e.solve(true)) return {};
  const Matrix all = e.of.matrix();
  const Vector right = e.of.right();
  for (signed char& s : e.sign) s = -1;
  if (!e.solve(true)) return {};
  const Matrix other = e.of.matrix();
  const Eigen::Index n = 3 * scene.bodies, contacts_of_all = contacts(scene), first = all.rows() - contacts_of_all;
  const Matrix M = all.topLeftCorner(n, n), inverse = M.inverse();
  const Matrix J = all.block(n, 0, first - n, n), N = all.bottomLeftCorner(contacts_of_all, n);
  // Columns hold minus the force of a unit of lambda >= 0, and of lambda <= 0.
  const Matrix plus = all.topRightCorner(n, contacts_of_all), minus = other.topRightCorner(n, contacts_of_all);
  const Matrix reduced = inverse - inverse * J.transpose() * (J * inverse * J.transpose()).inverse() * J * inverse;
  const Vector h = right.head(n), c_J = right.segment(n, first - n), c_N = right.tail(contacts_of_all);
  const Vector free = reduced * h + inverse * J.transpose() * (J * inverse * J.transpose()).inverse() * c_J;
  const Matrix S = N * reduced * N.transpose(), S_star = N * reduced * (minus - plus) / 2;
  const Vector b = c_N - N * free;
  Vector lambda = S.inverse() * b;
  for (int round = 0; round < 8; ++round) {
    const Vector signs = lambda.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
    const Vector next = (S + S_star * signs.asDiagonal()).inverse() * b;
    const bool same = (next.array() * signs.array() >= 0).all();
    lambda = next;
    if (same) break;
  }
  if (!std::isfinite(lambda.sum())) return {};
  return {lambda.data(), lambda.data() + lambda.size()};
}

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
                    {"the whole system, LU", by_lu, {2, 2, false}},
                    {"the paper's inverses", by_inverses, {1, 1, false}}};

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
  Line bound{"rounding of the state, by the oracle", {6, -1, true}, {}, {}};
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
