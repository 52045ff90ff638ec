#include "full_system.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "motion/cartesian.hpp"

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

}  // namespace

std::vector<double> forces_by_lu(const RunScene& scene, const State& state) {
  Equations e(scene, state);
  std::vector<double> lambda;
  if (!e.solve(false)) return lambda;
  for (int c = 0; c < contacts(scene); ++c) lambda.push_back(e.of.lambda(c));
  return lambda;
}

std::vector<double> forces_by_inverses(const RunScene& scene, const State& state) {
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

}  // namespace slideway::charts
