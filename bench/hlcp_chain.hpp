// Random problems like a mechanism's: contacts along a chain of bodies.
#pragma once

#include <cmath>
#include <random>
#include <slideway/hlcp_problem.hpp>
#include <vector>

namespace chain {

using slideway::Hlcp;
using slideway::HlcpSolution;

inline constexpr int problem_count = 64;

/// A chain of N + 1 planar bodies (x, y, angle; unit mass, unit inertia), contact i between bodies i and i + 1: random
/// unit normal, random levers of at most 1/2 m, sliding direction at right angles. S = N N', S* = -N T' diag(mu s), mu
/// 0.1 to 0.3, s = +-1; signs of the solution random.
template <int N>
struct Problem {
  Hlcp<N> hlcp;
  HlcpSolution<N> solution;
  double w[N][N];  ///< W of the solution's signs
};

template <int N>
std::vector<Problem<N>> problems() {
  constexpr int columns = 3 * (N + 1);
  std::mt19937_64 random(42);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<Problem<N>> all(problem_count);
  for (Problem<N>& problem : all) {
    double row[N][columns] = {};
    double slide[N][columns] = {};
    for (int i = 0; i < N; ++i) {
      const double angle = 6.283185307179586 * uniform(random);
      for (int body = 0; body < 2; ++body) {
        const double side = body == 0 ? -1.0 : 1.0;
        const int first = 3 * (i + body);
        row[i][first] = -side * std::sin(angle);
        row[i][first + 1] = side * std::cos(angle);
        row[i][first + 2] = uniform(random) - 0.5;
        slide[i][first] = side * std::cos(angle);
        slide[i][first + 1] = side * std::sin(angle);
        slide[i][first + 2] = uniform(random) - 0.5;
      }
    }
    for (int j = 0; j < N; ++j) {
      const double mu = (random() % 2 != 0 ? 1 : -1) * (0.1 + 0.2 * uniform(random));
      for (int i = 0; i < N; ++i) {
        double s = 0.0;
        double star = 0.0;
        for (int k = 0; k < columns; ++k) {
          s += row[i][k] * row[j][k];
          star -= row[i][k] * slide[j][k] * mu;
        }
        problem.hlcp.plus[i][j] = s + star;
        problem.hlcp.minus[i][j] = s - star;
      }
    }
    problem.solution = {};
    double x[N];
    for (int k = 0; k < N; ++k) {
      x[k] = normal(random);
      problem.solution.sign[k] = static_cast<signed char>(x[k] < 0.0 ? -1 : 1);
    }
    for (int i = 0; i < N; ++i) {
      problem.hlcp.b[i] = 0.0;
      for (int j = 0; j < N; ++j) {
        problem.w[i][j] = x[j] < 0.0 ? problem.hlcp.minus[i][j] : problem.hlcp.plus[i][j];
        problem.hlcp.b[i] += problem.w[i][j] * x[j];
      }
    }
  }
  return all;
}

}  // namespace chain
