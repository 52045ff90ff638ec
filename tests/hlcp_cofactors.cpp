// Orders 3 and 4 by cofactors: against whole numbers, and where elimination takes over.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <slideway/hlcp.hpp>
#include <type_traits>

using namespace slideway;

namespace {

template <int N>
using Whole = std::int64_t[N][N];

template <int N>
std::int64_t determinant(const Whole<N>& a) {
  if constexpr (N == 1) {
    return a[0][0];
  } else {
    std::int64_t sum = 0;
    for (int k = 0; k < N; ++k) {
      Whole<N - 1> rest;
      for (int i = 1; i < N; ++i)
        for (int j = 0, at = 0; j < N; ++j)
          if (j != k) rest[i - 1][at++] = a[i][j];
      sum += (k % 2 == 0 ? 1 : -1) * a[0][k] * determinant<N - 1>(rest);
    }
    return sum;
  }
}

std::int64_t digit(std::mt19937_64& random) { return static_cast<std::int64_t>(random() % 19) - 9; }

double entry(const hlcp_detail::Column& row, int k) { return (k % 2 == 0 ? row.even : row.odd)[k / 2]; }

template <int N>
void expect_adjugates() {
  std::mt19937_64 random(6);
  for (int round = 0; round < 200; ++round) {
    Whole<N> w;
    double real[N][N + N % 2] = {};
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) real[i][j] = static_cast<double>(w[i][j] = digit(random));
    const hlcp_detail::Adjugate adjugate = hlcp_detail::adjugate_of(real, std::integral_constant<int, N>{});
    const double det = static_cast<double>(determinant<N>(w));
    EXPECT_EQ(adjugate.determinant, det);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        double sum = 0;
        for (int k = 0; k < N; ++k) sum += entry(adjugate.row[i], k) * real[k][j];
        EXPECT_EQ(sum, i == j ? det : 0.0) << N << ": " << i << ", " << j;
      }
  }
}

TEST(Cofactors, OfWholeNumbersAreExact) {
  expect_adjugates<3>();
  expect_adjugates<4>();
}

template <int N>
void expect_least_determinants() {
  std::mt19937_64 random(7);
  int of_one_sign = 0;
  for (int round = 0; round < 400; ++round) {
    Whole<N> plus, minus;
    Hlcp<N> problem = {};
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        const std::int64_t diagonal = i == j ? (round % 2 == 0 ? 12 : -12) : 0;  // the W-property in every other one
        problem.plus[i][j] = static_cast<double>(plus[i][j] = digit(random) + diagonal);
        problem.minus[i][j] = static_cast<double>(minus[i][j] = digit(random) / 4 + diagonal);
      }
    std::int64_t first = 0, least = std::numeric_limits<std::int64_t>::max();
    for (int code = 0; code < 1 << N; ++code) {
      Whole<N> w;
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) w[i][j] = (code >> j) % 2 == 0 ? plus[i][j] : minus[i][j];
      const std::int64_t det = determinant<N>(w);
      if (code == 0) first = det;
      least = std::min(least, first < 0 ? -det : det);
    }
    of_one_sign += least > 0 ? 1 : 0;
    EXPECT_EQ(hlcp_detail::least_determinant(problem, std::integral_constant<int, N>{}), static_cast<double>(least));
  }
  EXPECT_GT(of_one_sign, 20);
  EXPECT_LT(of_one_sign, 380);
}

TEST(Cofactors, GiveTheLeastOfAllDeterminants) {
  expect_least_determinants<3>();
  expect_least_determinants<4>();
}

/// Two rows that differ by `gap`, beside the unit matrix; det W = gap.
Hlcp<4> nearly_singular(double gap) {
  Hlcp<4> problem = {};
  const double block[2][2] = {{1, 1}, {1, 1 + gap}};
  const double x[4] = {1, 2, 3, 4};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      problem.plus[i][j] = problem.minus[i][j] = i < 2 && j < 2 ? block[i][j] : i == j ? 1 : 0;
      problem.b[i] += problem.plus[i][j] * x[j];
    }
  return problem;
}

TEST(Cofactors, LeaveIllConditionedProblemsToElimination) {
  const signed char plus[4] = {1, 1, 1, 1};
  for (const int exponent : {-10, -17, -19, -40}) {
    const Hlcp<4> problem = nearly_singular(std::ldexp(1.0, exponent));
    hlcp_detail::Trial<4> trial;
    ASSERT_TRUE(hlcp_detail::solve_unchecked(problem, std::integral_constant<int, 4>{}, plus, trial));
    EXPECT_EQ(trial.cofactors, exponent > -18) << exponent;  // 2^-20 times the rows' 2 * 2 * 1 * 1
    HlcpSolution<4> solution = {};
    solve(problem, std::integral_constant<int, 4>{}, solution);
    ASSERT_EQ(solution.status, Status::ok) << exponent;
    EXPECT_EQ(solution.uniqueness, Uniqueness::certified) << exponent;
    EXPECT_EQ(solution.bounded, exponent >= -19) << exponent;
    for (int k = 0; k < 4; ++k) EXPECT_EQ(solution.x[k], k + 1.0) << exponent;
  }
}

TEST(Cofactors, ServeFromTheirLimitOn) {
  const signed char plus[4] = {1, 1, 1, 1};
  for (const double beside : {1023.0, 1024.0}) {  // det W = 1, rows of 1024, 1024, 1, 1: just 2^20; or 1025
    Hlcp<4> problem = {};
    for (int i = 0; i < 4; ++i) problem.plus[i][i] = problem.minus[i][i] = 1;
    for (int i = 0; i < 2; ++i) problem.plus[i][i + 1] = problem.minus[i][i + 1] = beside;
    hlcp_detail::Trial<4> trial;
    ASSERT_TRUE(hlcp_detail::solve_unchecked(problem, std::integral_constant<int, 4>{}, plus, trial));
    EXPECT_EQ(trial.cofactors, beside < 1024);
  }
}

TEST(Cofactors, ThatMissAnEquationAreRepairedByElimination) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  const signed char plus[4] = {1, 1, 1, 1};
  int by_cofactors = 0, repaired = 0;
  for (int round = 0; round < 4000; ++round) {
    Hlcp<4> problem = {};
    for (int i = 0; i < 4; ++i) {
      problem.b[i] = number(random);
      for (int j = 0; j < 4; ++j)
        problem.plus[i][j] = i == 3 ? problem.plus[2][j] + std::ldexp(number(random), -10) : number(random);
    }
    std::copy(&problem.plus[0][0], &problem.plus[0][0] + 16, &problem.minus[0][0]);
    hlcp_detail::Trial<4> trial;
    ASSERT_TRUE(hlcp_detail::solve_unchecked(problem, std::integral_constant<int, 4>{}, plus, trial));
    if (!trial.cofactors) continue;
    EXPECT_TRUE(hlcp_detail::attempt_many(problem, std::integral_constant<int, 4>{}, plus, trial)) << round;
    EXPECT_LE(trial.residual, hlcp_detail::residual_limit(4)) << round;
    (trial.cofactors ? by_cofactors : repaired) += 1;
  }
  EXPECT_GT(by_cofactors, 3000);
  EXPECT_GT(repaired, 20);
  RecordProperty("by_cofactors", by_cofactors);
  RecordProperty("repaired", repaired);
}

TEST(Hlcp, GoesOnFromATrialWithAZero) {
  // W(+) x = b has x = (-1, 0, 1): the zero's sign is open, and no reason to start again with care.
  Hlcp<3> problem = {};
  const double plus[3][3] = {{2, 1, 0}, {0, 2, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      problem.plus[i][j] = plus[i][j];
      problem.minus[i][j] = plus[i][j] + (i == 1 && j == 0 ? 0.5 : 0);
    }
  problem.b[0] = -2;
  problem.b[2] = 1;
  HlcpSolution<3> solution = {};
  solve(problem, std::integral_constant<int, 3>{}, solution);
  ASSERT_EQ(solution.status, Status::ok);
  EXPECT_EQ(solution.uniqueness, Uniqueness::certified);
  EXPECT_EQ(solution.solves, 2);
  EXPECT_EQ(solution.sign[0], -1);
  EXPECT_GT(solution.x[1], 0.1);
}

}  // namespace
