// Problems A+ x+ - A- x- = b at the edges of slideway::solve's branches: each is one that a small edit of the solver
// would answer otherwise, in its status, its certificate or its count of sign patterns.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <slideway/hlcp.hpp>
#include <string>
#include <support/litter.hpp>
#include <type_traits>
#include <utility>

namespace {

using slideway::Hlcp;
using slideway::HlcpOptions;
using slideway::HlcpSolution;
using slideway::NotUnique;
using slideway::Status;
using slideway::Uniqueness;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double most = std::numeric_limits<double>::max();

template <int N>
using Matrix = std::array<std::array<double, N>, N>;
template <int N>
using Vector = std::array<double, N>;

template <int N>
Hlcp<N> hlcp(const Matrix<N>& plus, const Matrix<N>& minus, const Vector<N>& b) {
  Hlcp<N> problem;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      problem.plus[i][j] = plus[i][j];
      problem.minus[i][j] = minus[i][j];
    }
    problem.b[i] = b[i];
  }
  return problem;
}

Hlcp<1> single(double plus, double minus, double b) { return hlcp<1>({{{plus}}}, {{{minus}}}, {b}); }

/// Bit k of `code` set: component k is first tried negative.
template <int N>
HlcpSolution<N> answer(const Hlcp<N>& problem, unsigned code = 0, HlcpOptions options = {}) {
  HlcpSolution<N> solution = {};
  for (int k = 0; k < N; ++k) solution.sign[k] = static_cast<signed char>(((code >> k) & 1) != 0 ? -1 : 1);
  slideway::solve(problem, std::integral_constant<int, N>{}, solution, options);
  return solution;
}

template <int N>
void expect_certified(const Hlcp<N>& problem, const Vector<N>& x, int solves, unsigned code = 0) {
  const HlcpSolution<N> solution = answer(problem, code);
  ASSERT_EQ(solution.status, Status::ok) << name(solution.status);
  EXPECT_EQ(name(solution.uniqueness), std::string("certified"));
  EXPECT_EQ(solution.solves, solves);
  for (int k = 0; k < N; ++k) EXPECT_EQ(solution.x[k], x[k]) << k;
}

/// Row i has `plus` and `minus` in column place[i], and zeros; b = 1. |plus - minus| >= plus: no proof by contraction.
template <int N>
Hlcp<N> monomial(const std::array<int, N>& place, double plus, double minus) {
  Hlcp<N> problem = {};
  for (int i = 0; i < N; ++i) {
    problem.plus[i][place[i]] = plus;
    problem.minus[i][place[i]] = minus;
    problem.b[i] = 1.0;
  }
  return problem;
}

template <int N>
std::array<int, N> in_order() {
  std::array<int, N> place;
  for (int i = 0; i < N; ++i) place[i] = i;
  return place;
}

// ---- order 1

TEST(HlcpEdges, AQuotientBeyondTheRangeIsRefused) {
  // 2^1073 is no double.
  EXPECT_EQ(answer(single(0x1p-1073, 0x1p-1073, 1.0)).status, Status::inaccurate);
  EXPECT_EQ(answer(single(0x1p-1074, 0x1p-1074, -1.0), 1).status, Status::inaccurate);
}

TEST(HlcpEdges, AQuotientOfAnyNonzeroCoefficientsTakesOneSolve) {
  for (const double p : {0x1p-1074, 0x1p-1022, 1.0, most})
    for (const double m : {0x1p-1074, 0x1p-1022, 1.0, most}) {
      expect_certified<1>(single(p, m, p), {1.0}, 1);
      expect_certified<1>(single(p, m, -m), {-1.0}, 1);
      expect_certified<1>(single(p, m, 0.0), {0.0}, 1, 1);
    }
}

TEST(HlcpEdges, AZeroCoefficientIsNoQuotient) {
  EXPECT_EQ(answer(single(0.0, 1.0, 0.0)).status, Status::not_unique);
  EXPECT_EQ(answer(single(1.0, 0.0, 0.0)).status, Status::not_unique);
  EXPECT_EQ(answer(single(0.0, 0.0, 0.0)).status, Status::not_unique);
  EXPECT_EQ(answer(single(infinity, 1.0, 0.0)).status, Status::invalid_input);
  EXPECT_EQ(answer(single(1.0, infinity, 0.0)).status, Status::invalid_input);
}

// ---- the count of sign patterns

TEST(HlcpEdges, OptionsAllowFourThousandSolves) { EXPECT_EQ(HlcpOptions{}.max_solves, 4096); }

TEST(HlcpEdges, AnExactDecisionCountsItsDeterminantsAndItsTrials) {
  // Nothing solved before: 2 determinants, 1 trial with the signs found.
  const HlcpSolution<1> one = answer(single(2.0, 0.0, 3.0));
  EXPECT_EQ(one.uniqueness, Uniqueness::single);
  EXPECT_EQ(one.solves, 3);
  // 2 determinants, and no solution to try.
  EXPECT_EQ(answer(single(1.0, -1.0, -1.0)).solves, 2);
  // No trial of the pair: 4 determinants, 1 trial.
  EXPECT_EQ(answer(hlcp<2>({{{1.0, 0.0}, {0.0, 1.0}}}, {{{1.0, 0.0}, {0.0, 0.0}}}, {1.0, 1.0})).solves, 5);
}

TEST(HlcpEdges, AWrongSignCostsOneSolveMoreWhicheverItIs) {
  // At once, and with the signs corrected.
  for (int k = 0; k < 3; ++k) expect_certified<3>(monomial<3>(in_order<3>(), 1.0, 128.0), {1.0, 1.0, 1.0}, 2, 1U << k);
}

// ---- the W-property, by determinants

TEST(HlcpEdges, APairWithTheWPropertyTakesOneSolve) {
  // Both rows of A+ and A- differ, so that none can stand for another.
  const Hlcp<2> problem = hlcp<2>({{{2.0, 1.0}, {0.0, 4.0}}}, {{{64.0, 1.0}, {1.0, 128.0}}}, {3.0, 4.0});
  expect_certified<2>(problem, {1.0, 1.0}, 1);
}

/// A- negated in one column, of A+'s size or 128 times that: component k is 1, or negative. Only A- shows it.
template <int N>
void expect_refuted_through_each_column_of_minus(const std::array<int, N>& place) {
  for (int k = 0; k < N; ++k)
    for (const double size : {1.0, 128.0}) {
      Hlcp<N> problem = monomial<N>(place, 1.0, size);
      for (int i = 0; i < N; ++i) problem.minus[i][k] = -problem.minus[i][k];
      const HlcpSolution<N> solution = answer(problem);
      EXPECT_EQ(solution.status, Status::not_unique) << name(solution.status) << " column " << k;
    }
}

/// Every term of a determinant of order N alone.
template <int N>
void expect_one_solve_for_every_permutation() {
  std::array<int, N> place = in_order<N>();
  do {
    expect_certified<N>(
        monomial<N>(place, 1.0, 128.0),
        [] {
          Vector<N> ones;
          ones.fill(1.0);
          return ones;
        }(),
        1);
    expect_refuted_through_each_column_of_minus<N>(place);
  } while (std::next_permutation(place.begin(), place.end()));
}

TEST(HlcpEdges, EveryTermOfEveryDeterminantCounts) {
  expect_one_solve_for_every_permutation<2>();
  expect_one_solve_for_every_permutation<3>();
  expect_one_solve_for_every_permutation<4>();
}

TEST(HlcpEdges, ADeterminantLostInRoundingHasItsExactSign) {
  // det A- = +-2^-52 of terms of size 1: below the doubt of 2^-49 of their sum. The other three are 1 or 2, about.
  const Matrix<2> one = {{{1.0, 0.0}, {0.0, 1.0}}};
  const auto solve = [&](double corner) {
    return answer(hlcp<2>(one, {{{1.0, 1.0}, {1.0, corner}}}, {1.0, 1.0})).uniqueness;
  };
  EXPECT_EQ(solve(1.0 + 0x1p-52), Uniqueness::certified);
  EXPECT_EQ(solve(1.0), Uniqueness::single);
  EXPECT_EQ(solve(1.0 - 0x1p-53), Uniqueness::single);
}

// ---- the W-property, by contraction

/// A+ has ones on the diagonal and above it (or below), A- = A+ - I 5/16: u = 1 shows nothing, for |A+^-1| 5/16 u is up
/// to 25/16, but one step of power iteration, u = (5, 4, 3, 2, 1), brings it to 15/16 u at most. A bound 2 times as
/// large for one of its terms needs more than the two steps that there are. x = 1.
Hlcp<5> nearly_expanding(bool above) {
  Hlcp<5> problem = {};
  for (int i = 0; i < 5; ++i) {
    const int other = above ? i + 1 : i - 1;
    for (auto* matrix : {problem.plus, problem.minus}) {
      matrix[i][i] = 1.0;
      if (other >= 0 && other < 5) matrix[i][other] = 1.0;
    }
    problem.minus[i][i] -= 5.0 / 16.0;
    problem.b[i] = other >= 0 && other < 5 ? 2.0 : 1.0;
  }
  return problem;
}

TEST(HlcpEdges, AProofByPowerIterationHolds) {
  expect_certified<5>(nearly_expanding(true), {1.0, 1.0, 1.0, 1.0, 1.0}, 1);
  expect_certified<5>(nearly_expanding(false), {1.0, 1.0, 1.0, 1.0, 1.0}, 1);
}

TEST(HlcpEdges, AProofByPowerIterationDoesNotDependOnTheRowsUnits) {
  for (const bool above : {true, false})
    for (const int step : {-30, -10, -3, 3, 10, 30}) {
      Hlcp<5> problem = nearly_expanding(above);
      for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
          problem.plus[i][j] = std::ldexp(problem.plus[i][j], step * i);
          problem.minus[i][j] = std::ldexp(problem.minus[i][j], step * i);
        }
        problem.b[i] = std::ldexp(problem.b[i], step * i);
      }
      expect_certified<5>(problem, {1.0, 1.0, 1.0, 1.0, 1.0}, 1);
    }
}

/// Three blocks ((1, 1), (1, 1 + e)), |W^-1| of about 2/e, A- = A+ - I 11/32 e: the bound is 11/16, and 1/4 for the
/// allowance of 2^-21 of the row sizes 2. Were that counted twice, if only for one row of a block, it would exceed 1.
TEST(HlcpEdges, AProofAllowsForRoundingOnce) {
  const double e = 0x1p-17;
  Hlcp<6> problem = {};
  for (int i = 0; i < 6; i += 2) {
    for (auto* matrix : {problem.plus, problem.minus}) {
      matrix[i][i] = matrix[i][i + 1] = matrix[i + 1][i] = 1.0;
      matrix[i + 1][i + 1] = 1.0 + e;
    }
    problem.minus[i][i] -= 11.0 / 32.0 * e;
    problem.minus[i + 1][i + 1] -= 11.0 / 32.0 * e;
    problem.b[i] = 2.0;
    problem.b[i + 1] = 2.0 + e;
  }
  expect_certified<6>(problem, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, 1);
}

// ---- which of several solutions

TEST(HlcpEdges, TheSignsGivenDecideEvenWhereTheyAreOfNoSolution) {
  // |x1| = 1, x2 = x3 = 1. With signs that no solution has, the one that sign iteration leads to is taken.
  const Matrix<3> plus = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  const Matrix<3> minus = {{{-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  const Hlcp<3> problem = hlcp<3>(plus, minus, {1.0, 1.0, 1.0});
  for (unsigned code = 0; code < 8; ++code) {
    EXPECT_EQ(answer(problem, code).status, Status::not_unique);
    const HlcpSolution<3> solution = answer(problem, code, {NotUnique::continue_along_signs});
    ASSERT_EQ(solution.status, Status::ok) << name(solution.status);
    EXPECT_EQ(solution.uniqueness, Uniqueness::refuted);
    EXPECT_EQ(solution.x[0], (code & 1) != 0 ? -1.0 : 1.0) << "from " << code;
    EXPECT_EQ(solution.x[1], 1.0);
    EXPECT_EQ(solution.x[2], 1.0);
  }
}

// ---- scales

template <int N>
Hlcp<N> scaled(Hlcp<N> problem, const std::array<int, N>& exponent) {
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      problem.plus[i][j] = std::ldexp(problem.plus[i][j], exponent[i]);
      problem.minus[i][j] = std::ldexp(problem.minus[i][j], exponent[i]);
    }
    problem.b[i] = std::ldexp(problem.b[i], exponent[i]);
  }
  return problem;
}

/// Of small integers, so that nothing is lost with rows near the least double.
template <int N>
Hlcp<N> integers(std::mt19937_64& random) {
  const auto draw = [&] { return static_cast<double>(static_cast<int>(random() % 9) - 4); };
  Hlcp<N> problem;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      problem.plus[i][j] = draw() + (i == j ? 6.0 : 0.0);
      problem.minus[i][j] = draw() + (i == j ? 6.0 : 0.0);
    }
    problem.b[i] = draw();
  }
  return problem;
}

template <int N>
void expect_the_same_in_units_of(const std::array<int, N>& exponent) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 100; ++round) {
    const Hlcp<N> problem = integers<N>(random);
    const HlcpSolution<N> plain = answer(problem);
    const HlcpSolution<N> solution = answer(scaled<N>(problem, exponent));
    ASSERT_EQ(solution.status, plain.status) << name(solution.status) << ", not " << name(plain.status);
    ASSERT_EQ(solution.uniqueness, plain.uniqueness) << name(solution.uniqueness);
    for (int k = 0; k < N && plain.status == Status::ok; ++k) ASSERT_EQ(solution.x[k], plain.x[k]) << "round " << round;
  }
}

TEST(HlcpEdges, RowsInAnyUnitGiveTheSameAnswer) {
  for (const int e : {-1074, -1070, -1022, -900, -300, -201, 201, 300, 900, 1018}) {
    expect_the_same_in_units_of<2>({e, 0});
    expect_the_same_in_units_of<2>({0, e});
    expect_the_same_in_units_of<3>({e, 0, 0});
    expect_the_same_in_units_of<3>({0, e, 0});
    expect_the_same_in_units_of<3>({0, 0, e});
    expect_the_same_in_units_of<4>({0, e, 0, e});
  }
}

/// Rows 1 and 3 (or, exchanged, 0 and 2) in units of 2^-537: products of both are in units of the least double, and the
/// terms 5/8 + 5/8 - 11/8 of the determinant with A-'s last column, which is -1/8, round to 1 + 1 - 1. With A+ it
/// is 16.
TEST(HlcpEdges, RowsAreScaledBeforeTheirDeterminantsUnderflow) {
  const Matrix<4> plus = {
      {{1.0, 0.0, 1.0, 0.0}, {0.0, 1.0, -1.0, 0.0}, {1.375, 0.625, 0.625, 8.0}, {1.0, 0.0, -1.0, 0.0}}};
  Matrix<4> minus = plus;
  minus[2][3] = 0.0;
  minus[3][3] = 1.0;
  const Vector<4> b = {2.0, 0.0, 10.625, 0.0};  // x = 1, and another x with the last component negative
  const std::array<int, 4> units = {0, -537, 0, -537};
  const Hlcp<4> tiny = scaled<4>(hlcp<4>(plus, minus, b), units);
  Hlcp<4> exchanged = tiny;
  for (int i = 0; i < 4; i += 2) {
    std::swap(exchanged.plus[i], exchanged.plus[i + 1]);
    std::swap(exchanged.minus[i], exchanged.minus[i + 1]);
    std::swap(exchanged.b[i], exchanged.b[i + 1]);
  }
  for (const Hlcp<4>& problem : {hlcp<4>(plus, minus, b), tiny, exchanged}) {
    const HlcpSolution<4> solution = answer(problem);
    EXPECT_EQ(solution.status, Status::not_unique) << name(solution.status) << " " << name(solution.uniqueness);
  }
}

TEST(HlcpEdges, ASubnormalRightSideIsScaledByItsOwnSize) {
  // |x1| = -2^-1074 has no solution. Exact signs need b within 2^-180 of its largest, over their rows: here just so.
  const Hlcp<2> problem =
      hlcp<2>({{{1.0, 0.0}, {0.0, 0x1p180}}}, {{{-1.0, 0.0}, {0.0, 0x1p180}}}, {-0x1p-1074, 0x1p-1074});
  EXPECT_EQ(answer(problem).status, Status::no_solution) << name(answer(problem).status);
}

// ---- what underflow hides

template <int N>
void expect_refused(const Hlcp<N>& problem, Status status) {
  for (unsigned code = 0; code < (1U << N); ++code)
    for (const NotUnique policy : {NotUnique::refuse, NotUnique::continue_along_signs}) {
      const HlcpSolution<N> solution = answer(problem, code, {policy});
      EXPECT_EQ(name(solution.status), std::string(name(status))) << "from " << code;
    }
}

TEST(HlcpEdges, ARowWhoseTermsUnderflowIsNotSatisfied) {
  // x = (5e-324 / 12.25 times 5.7e-56, -5.7e-56): without x1's coefficient, which is lost beside 12.25 when rows are
  // scaled, row 2 would be 12.25 x1 = 0.
  expect_refused(hlcp<2>({{{12.25, -1.0}, {12.25, 1.125}}}, {{{12.25, -0x1p988}, {12.25, 0x1p-1074}}}, {0x1p805, 0.0}),
                 Status::inaccurate);
  expect_refused(hlcp<2>({{{0.0, 13.25}, {most, most}}}, {{{0.0, 13.25}, {3.0, 0x1p-926}}}, {-0x1p334, 0.0}),
                 Status::inaccurate);
}

TEST(HlcpEdges, MinorsThatUnderflowDecideNothing) {
  // The W-property holds; rows 1 and 3 over their largest entries leave b's minors below 2^-1074.
  const Hlcp<3> one =
      hlcp<3>({{{0x1p748, 11.75, 11.75}, {11.75, 11.75, 11.75}, {-0x1p987, 11.75, -16.0}}},
              {{{most, 11.75, 11.75}, {11.75, 11.75, 11.75}, {11.75, 11.75, -0x1p567}}}, {11.75, 0.0, 0x1p374});
  expect_refused(one, Status::inaccurate);
}

TEST(HlcpEdges, OneOfTwoSolutionsIsBeyondTheRangeFromEveryStart) {
  expect_refused(hlcp<2>({{{-5.375, 3.875}, {0.0, 1.0}}}, {{{-2.125, -0x1p921}, {15.625, -14.75}}}, {0.0, most}),
                 Status::inaccurate);
}

TEST(HlcpEdges, EntriesBelowTheRangeOfTheirRowDoNoHarmWhereTheirTermsAreNone) {
  // 2^-1074 is lost beside 2^500, from starts that need scaling; x = (-2^-500, 1/2) all the same.
  const Hlcp<2> problem = hlcp<2>({{{1.0, 0.0}, {0.0, 2.0}}}, {{{0x1p500, 0x1p-1074}, {0.0, 1.0}}}, {-1.0, 1.0});
  for (unsigned code = 0; code < 4; ++code) {
    const HlcpSolution<2> solution = answer(problem, code);
    ASSERT_EQ(solution.status, Status::ok) << name(solution.status);
    EXPECT_EQ(solution.uniqueness, Uniqueness::certified);
    EXPECT_EQ(solution.x[0], -0x1p-500);
    EXPECT_EQ(solution.x[1], 0.5);
  }
}

TEST(HlcpEdges, ARankThatRestsOnRoundingIsRefused) {
  // x2 = -0.375 satisfies the first equation, and the second but for its last digit; x1 is free.
  const Hlcp<2> problem = hlcp<2>({}, {{{0.0, -14.59375}, {0.0, 19.416341145833332}}}, {5.47265625, -7.2811279296875});
  expect_refused(problem, Status::singular_constraints);
}

TEST(HlcpEdges, ASolutionByMinorsHasTheSignsThatWereDecided) {
  // Two solutions beside (0, -4.5, 0, 0), in other components of which minors round to the wrong side of zero; the
  // last equation is then -9 x1 - 8 x3 = 0 or -32 x1 = 0, by these signs.
  const Hlcp<4> problem = hlcp<4>(
      {{{31.75, 6.0, 0.0, -8.999999999999993},
        {9.75, -8.999999932944775, 14.499999891966581, 14.00000000000005},
        {-13.250000000000188, 0.0, 0.0, -0.5},
        {-9.0, 21.25, 0.0, 0.0}}},
      {{{14.5, 14.5, -9.0, -9.0}, {-9.0, 7.0, -15.25, -12.75}, {9.5, -0.25, 0.0, 0.0}, {-32.0, 0.0, -8.0, 0.0}}},
      {-65.25000000000003, -31.5, 1.125, 0.0});
  for (unsigned code = 0; code < 16; ++code) {
    const HlcpSolution<4> solution = answer(problem, code, {NotUnique::continue_along_signs});
    ASSERT_EQ(solution.status, Status::ok) << name(solution.status);
    for (int i = 0; i < 4; ++i) {
      double miss = -problem.b[i];
      double size = std::fabs(problem.b[i]);
      for (int k = 0; k < 4; ++k) {
        const double term = (solution.x[k] < 0.0 ? problem.minus : problem.plus)[i][k] * solution.x[k];
        miss += term;
        size += std::fabs(term);
      }
      EXPECT_LE(std::fabs(miss), 6 * 5 * 0x1p-53 * size) << "equation " << i << " from " << code;
    }
  }
}

TEST(HlcpEdges, ASolutionByMinorsReadsNothingThatWasNotSet) {
  // x = 0 with a row of zeros: no pattern can be solved with. Arrays go in pairs, and order 3 leaves one half empty.
  const Hlcp<3> problem = hlcp<3>({{{1.0, -1.5, 1.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 2.0}}},
                                  {{{-1.5, 0.0, -2.75}, {0.0, 0.0, 0.0}, {0.0, -3.75, -1.25}}}, {0.0, 0.0, 0.0});
  for (unsigned code = 0; code < 8; ++code) {
    slideway::test::litter_stack();
    const HlcpSolution<3> solution = answer(problem, code, {NotUnique::continue_along_signs});
    EXPECT_EQ(name(solution.status), std::string("ok")) << "from " << code;
    EXPECT_EQ(name(solution.uniqueness), std::string("refuted")) << "from " << code;
  }
}

TEST(HlcpEdges, BoundedAreAnswersWhoseInverseIsKnownToBeSmall) {
  EXPECT_TRUE(answer(hlcp<2>({{{1.0, 0.0}, {0.0, 1.0}}}, {{{1.0, 0.0}, {0.0, 1.0}}}, {1.0, -1.0}), 0).bounded);
  // The rows' angle is 2^-30: the determinant is that part of its terms.
  const Matrix<2> rows = {{{1.0, 1.0}, {1.0, 1.0 + 0x1p-30}}};
  const HlcpSolution<2> close = answer(hlcp<2>(rows, rows, {1.0, 1.0}), 0);
  EXPECT_EQ(close.status, Status::ok);
  EXPECT_FALSE(close.bounded);
  const Matrix<3> unit = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  EXPECT_TRUE(answer(hlcp<3>(unit, unit, {1.0, -1.0, 1.0}), 0).bounded);
  const Matrix<3> flat = {{{1.0, 1.0, 0.0}, {1.0, 1.0 + 0x1p-30, 0.0}, {0.0, 0.0, 1.0}}};
  EXPECT_FALSE(answer(hlcp<3>(flat, flat, {1.0, 1.0, 1.0}), 0).bounded);
}

// ---- what rounding hides above order four

/// Neither `not_unique` nor ok and `refuted`, from any start.
void expect_no_claim_of_several(const Hlcp<5>& problem) {
  for (unsigned code = 0; code < 32; ++code) {
    EXPECT_NE(answer(problem, code).status, Status::not_unique) << "from " << code;
    const HlcpSolution<5> solution = answer(problem, code, {NotUnique::continue_along_signs});
    EXPECT_NE(name(solution.uniqueness), std::string("refuted")) << "from " << code;
    EXPECT_NE(name(solution.uniqueness), std::string("certified")) << "from " << code;
  }
}

TEST(HlcpEdges, SolutionsThatRoundingMakesAreNotCounted) {
  // The last row is three times the first, of b it is not: no solution.
  expect_no_claim_of_several(hlcp<5>({{{-1.875, -1.875, -1.875, -1.875, -1.875},
                                       {10.75, -10.0, 0.0, -1.875, 3.125},
                                       {-1.875, -1.875, -1.875, -1.875, 14.625},
                                       {-2.5, 1.375, 2.5, 0.0, 0.125},
                                       {-5.625, -5.625, -5.625, -5.625, -5.625}}},
                                     {{{-1.875, -11.375, -1.875, -1.875, 11.625},
                                       {-13.0, -5.375, 0.0, -1.875, -1.875},
                                       {-1.875, -1.875, -1.875, 14.875, -3.75},
                                       {0.5, -0.125, -4.5, -0.875, 0.5},
                                       {-5.625, -34.125, -5.625, -5.625, 34.875}}},
                                     {-2.0, -1.875, 0.125, 0.0, 14.875}));
  // One solution.
  expect_no_claim_of_several(hlcp<5>({{{-1.875, 0.0, -7.5, -1.875, -1.875},
                                       {10.75, -7.125, 0.0, 0.0, 0.0},
                                       {0.0, 0.0, 2.375, 0.0, -2.25},
                                       {0.0, -0.625, -0.625, -0.625, -0.625},
                                       {-0.625, -0.625, -0.625, -0.625, -0.625}}},
                                     {{{-0.125, 0.0, -1.875, -1.875, 11.625},
                                       {-13.0, 0.0, 0.0, 0.0, 0.0},
                                       {0.0, -0.25, -0.125, 0.0, 15.125},
                                       {0.0, -0.625, -0.625, -0.625, -0.625},
                                       {-0.625, -0.625, -0.625, -0.625, -0.625}}},
                                     {-2.0, -15.625, 8.375, -0.625, 0.0}));
}

TEST(HlcpEdges, ASolutionThatRoundingMakesIsUnproven) {
  // x = (0, 0, -16, 10.625, 10.625) misses the first equation by rounding alone, in digits beyond 1e-14; x1 and x2,
  // which would have to pay for it, have wrong signs then.
  const Hlcp<5> problem = hlcp<5>({{{-10.5, 6.000000000000021, -15.250000000000217, -12.750000000000181, -13.25},
                                    {0.0, 0.0, 0.0, -2.75, -2.5},
                                    {-1.25, 0.0, 0.0, 0.0, 9.75},
                                    {-9.0, -9.0, -9.0, -9.0, 0.0},
                                    {0.0, 0.0, -9.0, -9.0, -9.0}}},
                                  {{{14.5, 14.5, 14.0, -12.0, 9.75},
                                    {0.0, 0.0, 0.0, -1.25, -1.0},
                                    {0.0, 0.25, 0.0, 0.0, -9.0},
                                    {-9.0, -9.0, -9.0, -4.5, 0.0},
                                    {0.0, 0.0, -9.0, -9.0, -9.0}}},
                                  {-500.25, -55.78125, 103.59375, 48.375, -47.25});
  for (unsigned code = 0; code < 32; ++code)
    EXPECT_EQ(name(answer(problem, code).uniqueness), std::string("unproven")) << "from " << code;
}

TEST(HlcpEdges, ACertifiedTieHasTheSameBitsFromEveryStart) {
  // x1 alone is clearly not zero, and from some starts the proof succeeds only at another pattern of the tie.
  const Hlcp<5> problem = hlcp<5>({{{2.2158381900172497e-18, -3.2271955290388843e-18, -2.0244087439377778e-19,
                                     3.3322276144984175e-18, -4.743384504624082e-20},
                                    {-3.025601687592361e-18, 2.332898143327794e-17, 8.351744859927401e-19,
                                     -1.1304501714055892e-17, 9.131015171401358e-19},
                                    {-4.1504614415460717e-20, 7.555533889508359e-19, 7.820655201998955e-18,
                                     -3.1340219048409113e-19, 1.8151916059659656e-18},
                                    {3.3322276144984175e-18, -1.1409533799515426e-17, -3.1340219048409113e-19,
                                     1.408700494578627e-17, -4.379160337304733e-19},
                                    {-1.0164395367051604e-19, 9.147955830346444e-19, 2.0286439086740493e-18,
                                     -4.2436350657440447e-19, 1.3069718376133854e-18}}},
                                  {{{2.3513634615779377e-18, -3.0815058621111446e-18, 2.31239994600424e-19,
                                     3.765908483492619e-18, -2.608861477543245e-19},
                                    {-3.283099703557668e-18, 2.2946122541118996e-17, 6.454391058077769e-19,
                                     -1.1080885015980757e-17, 9.131015171401358e-19},
                                    {7.030373462210693e-20, 7.250602028496811e-19, 8.254336070993157e-18,
                                     1.2027867851011065e-19, 2.2488724749601674e-18},
                                    {3.765908483492619e-18, -1.0975852930521224e-17, 1.2027867851011065e-19,
                                     1.406328802326315e-17, -4.2097537478538727e-19},
                                    {-2.0667603913004928e-19, 9.114074512456272e-19, 2.0354201722520837e-18,
                                     -4.345279019414561e-19, 1.300195574035351e-18}}},
                                  {-3.26317231788267e-35, 4.5562161037871864e-35, -9.756603111824986e-37,
                                   -5.22624788375589e-35, 2.8682062160063815e-36});
  const HlcpSolution<5> first = answer(problem);
  int certified = 0;
  for (unsigned code = 0; code < 32; ++code) {
    const HlcpSolution<5> solution = answer(problem, code);
    ASSERT_EQ(solution.status, Status::ok) << name(solution.status);
    if (solution.uniqueness != Uniqueness::certified) continue;
    ++certified;
    for (int k = 0; k < 5; ++k) EXPECT_EQ(solution.x[k], first.x[k]) << k << " from " << code;
  }
  EXPECT_GT(certified, 1);
  EXPECT_EQ(first.uniqueness, Uniqueness::certified);
}

}  // namespace
