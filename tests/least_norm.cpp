// The shortest vector that satisfies inequalities, beside the best of all sets of active ones.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <random>
#include <slideway/least_norm.hpp>
#include <vector>

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_rows = 10, most_dimension = 4;

/// min |x| with G x >= h by trying every set of at most `dimension` rows as equations; none if none satisfies the rest.
std::optional<VectorXd> by_enumeration(const MatrixXd& G, const VectorXd& h) {
  const auto rows = static_cast<int>(G.rows()), dimension = static_cast<int>(G.cols());
  std::optional<VectorXd> best;
  for (unsigned active = 0; active < (1u << rows); ++active) {
    if (__builtin_popcount(active) > dimension) continue;
    std::vector<int> set;
    for (int i = 0; i < rows; ++i) {
      if ((active >> i & 1u) != 0) set.push_back(i);
    }
    const MatrixXd A = G(set, Eigen::all);
    const VectorXd x =
        set.empty() ? VectorXd(VectorXd::Zero(dimension)) : VectorXd(A.completeOrthogonalDecomposition().solve(h(set)));
    if (!((G * x - h).array() >= -1e-9).all()) continue;
    if (!best || x.norm() < best->norm()) best = x;
  }
  return best;
}

struct Problem {
  MatrixXd G;
  VectorXd h;
};

/// Rows of unit length; h around zero, so that some are active and some problems have no solution.
Problem draw(std::mt19937& random, int rows, int dimension, double shift) {
  std::normal_distribution<double> normal;
  Problem p{MatrixXd(rows, dimension), VectorXd(rows)};
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < dimension; ++j) p.G(i, j) = normal(random);
    p.G.row(i).normalize();
    p.h[i] = 0.5 * normal(random) + shift;
  }
  return p;
}

TEST(LeastNorm, IsTheBestOfAllActiveSets) {
  std::mt19937 random(41);
  int solved = 0, empty = 0, at_corners = 0;
  double worst = 0;
  for (int k = 0; k < 4000; ++k) {
    const int dimension = 1 + k % most_dimension, rows = 1 + (k / most_dimension) % most_rows;
    const Problem p = draw(random, rows, dimension, k % 3 == 0 ? 0.3 : -0.3);
    slideway::LeastNorm<most_rows, most_dimension> problem;
    problem.dimension = dimension;
    for (int i = 0; i < rows; ++i) {
      double row[most_dimension];
      for (int j = 0; j < dimension; ++j) row[j] = p.G(i, j);
      problem.require(row, p.h[i]);
    }
    const auto expected = by_enumeration(p.G, p.h);
    // Beside the border between some and none neither says anything: a lengthy x.
    if (expected && expected->norm() > 100) continue;
    ASSERT_EQ(problem.solve(), expected.has_value()) << "problem " << k;
    if (!expected) {
      ++empty;
      continue;
    }
    ++solved;
    int active = 0;
    for (int i = 0; i < rows; ++i) active += std::fabs(p.G.row(i).dot(*expected) - p.h[i]) < 1e-9 ? 1 : 0;
    at_corners += active > 1 ? 1 : 0;
    for (int j = 0; j < dimension; ++j) worst = std::max(worst, std::fabs(problem.x[j] - (*expected)[j]));
  }
  // 2^-40 ends the passes; x is no better than its square root divided by what the active rows' angles leave.
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(solved, 2000);
  EXPECT_GT(empty, 300);
  EXPECT_GT(at_corners, 500);
  RecordProperty("worst", testing::PrintToString(worst));
}

TEST(LeastNorm, RowsThatSayTheSameTwiceAreOne) {
  slideway::LeastNorm<most_rows, most_dimension> problem;
  problem.dimension = 2;
  const double row[2] = {0.6, 0.8};
  for (int k = 0; k < 3; ++k) problem.require(row, 0.5);
  ASSERT_TRUE(problem.solve());
  EXPECT_NEAR(problem.x[0], 0.3, 1e-15);
  EXPECT_NEAR(problem.x[1], 0.4, 1e-15);
}

}  // namespace
