#include "naive.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace slideway::charts {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Problem {
  Eigen::Map<const Matrix> S, S_star;
  Eigen::Map<const Eigen::VectorXd> b;
  explicit Problem(const ContactProblem& p)
      : S(p.S.data(), p.n, p.n), S_star(p.S_star.data(), p.n, p.n), b(p.b.data(), p.n) {}
};

std::vector<double> answer(const Eigen::VectorXd& x) {
  if (!std::isfinite(x.sum())) return {};
  return {x.data(), x.data() + x.size()};
}

}  // namespace

std::vector<double> fixed_point(const ContactProblem& given) {
  constexpr int most = 100;
  const Problem p(given);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(p.S);
  Eigen::VectorXd x = lu.solve(p.b);
  for (int round = 0; round < most; ++round) {
    const Eigen::VectorXd next = lu.solve(p.b - p.S_star * x.cwiseAbs());
    const double change = (next - x).lpNorm<Eigen::Infinity>();
    x = next;
    if (change <= 1e-10 * x.lpNorm<Eigen::Infinity>()) return answer(x);
  }
  return {};
}

std::vector<double> projected_gauss_seidel(const ContactProblem& given) {
  constexpr int sweeps = 50;
  const Problem p(given);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(given.n);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int i = 0; i < given.n; ++i) {
      double rest = p.b(i);
      for (int j = 0; j < given.n; ++j) {
        if (j != i) rest -= p.S(i, j) * x(j) + p.S_star(i, j) * std::fabs(x(j));
      }
      x(i) = rest / (rest < 0 ? p.S(i, i) - p.S_star(i, i) : p.S(i, i) + p.S_star(i, i));
    }
  }
  return answer(x);
}

std::vector<double> lagged_normal_force(const ContactProblem& given, int steps) {
  const Problem p(given);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(p.S);
  Eigen::VectorXd x = lu.solve(p.b);
  for (int step = 0; step < steps; ++step) x = lu.solve(p.b - p.S_star * x.cwiseAbs()).eval();
  return answer(x);
}

}  // namespace slideway::charts
