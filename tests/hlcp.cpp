// Examples, literature values and contracts of slideway::solve for A+ x+ - A- x- = b, and a tiny world decided
// completely.
#define EIGEN_NO_MALLOC
#define EIGEN_STACK_ALLOCATION_LIMIT 0
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <slideway/hlcp.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// Doubles are promoted on purpose: what is compared with is computed in long double.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

namespace {

using slideway::Hlcp;
using slideway::HlcpOptions;
using slideway::HlcpSolution;
using slideway::NotUnique;
using slideway::solve_hlcp;
using slideway::Status;
using slideway::Uniqueness;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

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

/// S x + S*|x| = b.
template <int N>
Hlcp<N> absolute(const Matrix<N>& s, const Matrix<N>& star, const Vector<N>& b) {
  Hlcp<N> problem = hlcp<N>(s, s, b);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      problem.plus[i][j] += star[i][j];
      problem.minus[i][j] -= star[i][j];
    }
  return problem;
}

/// w - M z = q, w, z >= 0, w'z = 0, with x = w - z.
template <int N>
Hlcp<N> lcp(const Matrix<N>& m, const Vector<N>& q) {
  Matrix<N> one = {};
  for (int i = 0; i < N; ++i) one[i][i] = 1.0;
  return hlcp<N>(one, m, q);
}

template <int N>
HlcpSolution<N> start(std::uint64_t code) {
  HlcpSolution<N> solution = {};
  for (int k = 0; k < N; ++k) solution.sign[k] = static_cast<signed char>(((code >> k) & 1) != 0 ? -1 : 1);
  return solution;
}

/// Bit k of `code` set: component k is first tried negative.
template <int N>
HlcpSolution<N> answer(const Hlcp<N>& problem, std::uint64_t code = 0, HlcpOptions options = {}) {
  HlcpSolution<N> solution = start<N>(code);
  slideway::solve(problem, std::integral_constant<int, N>{}, solution, options);
  return solution;
}

template <int N>
bool same_bits(const HlcpSolution<N>& a, const HlcpSolution<N>& b) {
  return a.status == b.status && a.uniqueness == b.uniqueness && std::memcmp(a.x, b.x, sizeof a.x) == 0 &&
         std::memcmp(a.sign, b.sign, sizeof a.sign) == 0 && a.residual == b.residual;
}

template <int N>
void expect_solved_from_everywhere(const Hlcp<N>& problem, const Vector<N>& x, Uniqueness uniqueness,
                                   double tolerance) {
  const HlcpSolution<N> first = answer(problem);
  for (unsigned code = 0; code < (1U << N); ++code) {
    const HlcpSolution<N> solution = answer(problem, code);
    ASSERT_EQ(solution.status, Status::ok) << name(solution.status) << " from " << code;
    EXPECT_EQ(name(solution.uniqueness), std::string(name(uniqueness)));
    EXPECT_TRUE(same_bits(solution, first)) << "from " << code;
    for (int k = 0; k < N; ++k) EXPECT_NEAR(solution.x[k], x[k], tolerance * (1.0 + std::fabs(x[k])));
  }
}

Matrix<3> circulant(double a, double b, double c) { return {{{a, b, c}, {c, a, b}, {b, c, a}}}; }

template <int N>
Matrix<N> murty() {
  Matrix<N> m = {};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) m[i][j] = j == i ? 1.0 : 2.0;
  return m;
}

template <int N>
Matrix<N> transpose(const Matrix<N>& m) {
  Matrix<N> t;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) t[i][j] = m[j][i];
  return t;
}

template <int N>
Matrix<N> reversed(const Matrix<N>& m) {
  Matrix<N> r;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) r[i][j] = m[N - 1 - i][N - 1 - j];
  return r;
}

/// Checks ok and A+ x+ - A- x- = b to the bound promised, in long double.
template <int N>
void expect_residual(const Hlcp<N>& problem, const HlcpSolution<N>& solution) {
  ASSERT_EQ(solution.status, Status::ok) << name(solution.status);
  for (int i = 0; i < N; ++i) {
    long double miss = -static_cast<long double>(problem.b[i]);
    long double size = std::fabs(problem.b[i]);
    for (int j = 0; j < N; ++j) {
      ASSERT_TRUE(std::isfinite(solution.x[j]));
      const double w = solution.x[j] < 0.0 ? problem.minus[i][j] : problem.plus[i][j];
      miss += static_cast<long double>(w) * solution.x[j];
      size += std::fabs(static_cast<long double>(w) * solution.x[j]);
    }
    EXPECT_LE(std::fabs(miss), 5 * (N + 1) * 0x1p-53L * size) << "row " << i;
  }
  EXPECT_LE(solution.residual, 4 * (N + 1) * 0x1p-53);
}

// ---- literature

TEST(Hlcp, SolvesTheCycleOfSignIteration) {
  const double c = 1.1;
  const Matrix<3> s = circulant(2.0, 0.0, c);
  const Matrix<3> star = circulant(0.0, 0.0, c);
  // S = I + C, S* = C - I with C = [[1,0,c],[c,1,0],[0,c,1]]
  const Hlcp<3> problem = absolute<3>(s, star, {2.0, 2.0, 2.0});
  expect_solved_from_everywhere<3>(problem, {1 / (1 + c), 1 / (1 + c), 1 / (1 + c)}, Uniqueness::certified, 1e-15);
}

/// The same in blocks of three; before the first of them, x = 2.
template <int N>
Hlcp<N> cycles(int first) {
  Matrix<N> s = {};
  Matrix<N> star = {};
  Vector<N> b;
  for (int k = 0; k < first; ++k) s[k][k] = 1.0;
  for (int block = first; block < N; block += 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        s[block + i][block + j] = circulant(2.0, 0.0, 1.1)[i][j];
        star[block + i][block + j] = circulant(0.0, 0.0, 1.1)[i][j];
      }
  b.fill(2.0);
  return absolute<N>(s, star, b);
}

TEST(Hlcp, LeavesACycleAboveOrderFourByFlipsNotByEnumeration) {
  const Hlcp<9> problem = cycles<9>(0);
  const HlcpSolution<9> solution = answer(problem, 0x49);
  expect_residual(problem, solution);
  EXPECT_LE(solution.solves, 40);
}

TEST(Hlcp, LeavesTwentyOneCyclesByFlips) {
  // Every other unknown reversed, so that enumeration would begin 2^63 patterns before the solution. 101 is the start
  // that needs most flips; index 31, which may flip 2^32 times, is the first of its block and needs more than one.
  Hlcp<64> problem = cycles<64>(1);
  for (int i = 0; i < 64; ++i)
    for (int j = 1; j < 64; j += 2) {
      std::swap(problem.plus[i][j], problem.minus[i][j]);
      problem.plus[i][j] *= -1.0;
      problem.minus[i][j] *= -1.0;
    }
  const std::uint64_t right = 0xaaaaaaaaaaaaaaaa;
  const HlcpSolution<64> solution = answer(problem, right ^ 0xb6db6db6db6db6da);
  expect_residual(problem, solution);
  EXPECT_LE(solution.solves, 1 + 4 + 21 * 6);
  for (int k = 1; k < 64; ++k) EXPECT_NEAR(solution.x[k], (k % 2 != 0 ? -1.0 : 1.0) / 2.1, 1e-15);
}

TEST(Hlcp, SolvesKostrevasMatrix) {
  const Matrix<3> m = {{{1, 2, 0}, {0, 1, 2}, {2, 0, 1}}};
  const double z = 1.0 / 3.0;
  expect_solved_from_everywhere<3>(lcp<3>(m, {-1, -1, -1}), {-z, -z, -z}, Uniqueness::certified, 1e-15);
}

TEST(Hlcp, SolvesMurtysMatrixInBothOrdersAndTransposed) {
  constexpr int n = 8;
  Vector<n> ones;
  ones.fill(-1.0);
  Vector<n> powers;
  for (int i = 0; i < n; ++i) powers[i] = -(std::ldexp(1.0, n + 1) - std::ldexp(2.0, i));
  for (const Matrix<n>& m :
       {murty<n>(), transpose<n>(murty<n>()), reversed<n>(murty<n>()), reversed<n>(transpose<n>(murty<n>()))})
    for (const Vector<n>& q : {ones, powers})
      for (unsigned code = 0; code < (1U << n); code += 5) expect_residual(lcp<n>(m, q), answer(lcp<n>(m, q), code));
  // M lower triangular, q = -1: z = (1, 0, ..., 0), w = (0, 1, ..., 1).
  const HlcpSolution<n> solution = answer(lcp<n>(murty<n>(), ones));
  EXPECT_EQ(solution.x[0], -1.0);
  for (int k = 1; k < n; ++k) EXPECT_EQ(solution.x[k], 1.0);
}

TEST(Hlcp, SolvesMurtysMatrixOfOrderSixtyFourByIteration) {
  constexpr int n = 64;
  Vector<n> ones;
  ones.fill(-1.0);
  const Matrix<n> lower = murty<n>();
  for (const Matrix<n>& m : {lower, transpose<n>(lower), reversed<n>(lower), reversed<n>(transpose<n>(lower))})
    for (const std::uint64_t code : {0x0ULL, 0x1ULL, ~0x0ULL, 0x5555555555555555ULL, 0x123456789abcdef0ULL}) {
      const HlcpSolution<n> solution = answer(lcp<n>(m, ones), code);
      expect_residual(lcp<n>(m, ones), solution);
      EXPECT_LE(solution.solves, 1 + n + 4);
      const bool first = m[1][0] == lower[1][0];  // z_0 = 1, else z_63 = 1
      for (int k = 0; k < n; ++k) EXPECT_EQ(solution.x[k], k == (first ? 0 : n - 1) ? -1.0 : 1.0);
    }
}

TEST(Hlcp, IteratesWhereOnlyTheLastSignsChange) {
  // Murty's matrix behind 32 unknowns that are 1 from the first step on; by flips it would take 2^32.
  Matrix<64> m = {};
  Vector<64> q;
  for (int k = 0; k < 32; ++k) {
    m[k][k] = q[k] = 1.0;
    q[32 + k] = -1.0;
    for (int j = 0; j < 32; ++j) m[32 + k][32 + j] = transpose<32>(murty<32>())[k][j];
  }
  const HlcpSolution<64> solution = answer(lcp<64>(m, q));
  EXPECT_EQ(solution.status, Status::ok) << name(solution.status);
  EXPECT_LE(solution.solves, 1 + 32 + 4);
  for (int k = 0; k < 64; ++k) EXPECT_EQ(solution.x[k], k == 63 ? -1.0 : 1.0);
}

TEST(Hlcp, SolvesFathisMatrix) {
  constexpr int n = 8;
  const Matrix<n> m = murty<n>();
  Matrix<n> fathi = {};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) fathi[i][j] += m[i][k] * m[j][k];
  Vector<n> q;
  q.fill(-1.0);
  const Hlcp<n> problem = lcp<n>(fathi, q);
  for (unsigned code = 0; code < (1U << n); ++code) {
    const HlcpSolution<n> solution = answer(problem, code);
    expect_residual(problem, solution);
    EXPECT_DOUBLE_EQ(solution.x[0], -1.0);
    for (int k = 1; k < n; ++k) EXPECT_NEAR(solution.x[k], 1.0, 1e-12);
  }
}

// ---- none, one, two, a continuum

/// u for the slider of two masses and a light rod: 2u - 3|u| = r (Painleve-Klein, mu tan phi = 3, equal masses).
Hlcp<1> painleve_klein(double r) { return absolute<1>({{{2.0}}}, {{{-3.0}}}, {r}); }

TEST(Hlcp, RefusesWhenNoSolutionExists) {
  HlcpSolution<1> solution = start<1>(1);
  solution.x[0] = 42.0;
  slideway::solve(painleve_klein(1.0), 1, solution);
  EXPECT_EQ(solution.status, Status::no_solution);
  EXPECT_EQ(solution.x[0], 42.0) << "a refusal leaves x alone";
  EXPECT_EQ(solution.sign[0], -1);
}

TEST(Hlcp, RefusesTwoSolutionsUnlessToldToContinue) {
  const Hlcp<1> problem = painleve_klein(-1.0);
  for (unsigned code : {0U, 1U}) {
    const HlcpSolution<1> refused = answer(problem, code);
    EXPECT_EQ(refused.status, Status::not_unique);
    EXPECT_EQ(refused.uniqueness, Uniqueness::refuted);
    const HlcpSolution<1> taken = answer(problem, code, {NotUnique::continue_along_signs});
    EXPECT_EQ(taken.status, Status::ok);
    EXPECT_EQ(taken.uniqueness, Uniqueness::refuted);
    EXPECT_DOUBLE_EQ(taken.x[0], code == 0 ? 1.0 : -0.2);
  }
}

/// The overhung slider, in units of 1/100 m and N: contacts at -5 and +5, centre of mass 30 over the guide, mu = 1/5,
/// weight 10, applied moment: N1 + N2 = 10, 5 (N1 - N2) + 6 (|N1| + |N2|) = moment. The W-property fails: mu * 30 > 5.
Hlcp<2> overhung(double moment) {
  return absolute<2>({{{1.0, 1.0}, {5.0, -5.0}}}, {{{0.0, 0.0}, {6.0, 6.0}}}, {10.0, moment});
}

TEST(Hlcp, CountsTheSolutionsOfTheOverhungSlider) {
  EXPECT_EQ(answer(overhung(5.0)).status, Status::no_solution);
  const HlcpSolution<2> lifted = answer(overhung(10.0));
  ASSERT_EQ(lifted.status, Status::ok);
  EXPECT_EQ(lifted.uniqueness, Uniqueness::single);
  EXPECT_EQ(lifted.x[0], 0.0);
  EXPECT_EQ(lifted.x[1], 10.0);
  const HlcpOptions go_on = {NotUnique::continue_along_signs};
  const auto expect = [&](double moment, unsigned code, double n1, double n2) {
    EXPECT_EQ(answer(overhung(moment), code).status, Status::not_unique);
    const HlcpSolution<2> solution = answer(overhung(moment), code, go_on);
    ASSERT_EQ(solution.status, Status::ok);
    EXPECT_EQ(solution.uniqueness, Uniqueness::refuted);
    EXPECT_NEAR(solution.x[0], n1, 1e-13 * std::fabs(n1));
    EXPECT_NEAR(solution.x[1], n2, 1e-13 * std::fabs(n2));
  };
  expect(50.0, 0, 4.0, 6.0);
  expect(50.0, 1, -20.0, 30.0);
  expect(200.0, 2, 155.0 / 11.0, -45.0 / 11.0);
  expect(200.0, 1, -95.0, 105.0);
}

TEST(Hlcp, FindsAContinuum) {
  EXPECT_EQ(answer(hlcp<1>({{{1.0}}}, {{{0.0}}}, {0.0})).status, Status::not_unique);
  EXPECT_EQ(answer(hlcp<1>({{{0.0}}}, {{{0.0}}}, {0.0})).status, Status::not_unique);
  const Matrix<2> ones = {{{1.0, 1.0}, {1.0, 1.0}}};
  EXPECT_EQ(answer(hlcp<2>(ones, ones, {2.0, 2.0})).status, Status::not_unique);
  EXPECT_EQ(answer(hlcp<2>(ones, ones, {2.0, 1.0})).status, Status::no_solution);
}

TEST(Hlcp, AcceptsTheOnlySolutionWhereTheWPropertyFails) {
  const HlcpSolution<1> solution = answer(hlcp<1>({{{2.0}}}, {{{0.0}}}, {3.0}), 1);
  EXPECT_EQ(solution.status, Status::ok);
  EXPECT_EQ(solution.uniqueness, Uniqueness::single);
  EXPECT_EQ(solution.x[0], 1.5);
  // |x1| + |x2| = 0: every pattern is singular, and yet there is one solution.
  const Matrix<2> plus = {{{1.0, 1.0}, {0.0, 0.0}}};
  const Matrix<2> minus = {{{-1.0, -1.0}, {0.0, 0.0}}};
  const HlcpSolution<2> zero = answer(hlcp<2>(plus, minus, {0.0, 0.0}));
  EXPECT_EQ(zero.status, Status::ok);
  EXPECT_EQ(zero.uniqueness, Uniqueness::single);
  EXPECT_EQ(zero.x[0], 0.0);
  EXPECT_EQ(zero.x[1], 0.0);
}

/// A uniform rod (mass 1, half length 1) at 105 degrees on the x-axis (A) and on a guide inclined by 30 degrees (B), mu
/// = 0.3, starting to turn to the left, pushed with 10 N along itself from B to A. Unique only for mu < tan 15 degrees.
Hlcp<2> rod_on_two_guides() {
  const double degree = 3.14159265358979323846 / 180.0;
  const double along[2] = {std::cos(105.0 * degree), std::sin(105.0 * degree)};
  const double slip[2] = {1.0, -1.0};
  double normal[2][3];
  double slide[2][3];
  for (int k = 0; k < 2; ++k) {
    const double angle = k == 0 ? 0.0 : 30.0 * degree;
    const double end = k == 0 ? -1.0 : 1.0;
    const double t[2] = {std::cos(angle), std::sin(angle)};
    const double n[2] = {-t[1], t[0]};
    for (int c = 0; c < 2; ++c) {
      normal[k][c] = n[c];
      slide[k][c] = t[c];
    }
    normal[k][2] = end * (along[0] * n[1] - along[1] * n[0]);
    slide[k][2] = end * (along[0] * t[1] - along[1] * t[0]);
  }
  const double inverse_mass[3] = {1.0, 1.0, 3.0};
  Matrix<2> s = {};
  Matrix<2> star = {};
  Vector<2> b = {};
  for (int i = 0; i < 2; ++i)
    for (int c = 0; c < 3; ++c) {
      for (int j = 0; j < 2; ++j) {
        s[i][j] += normal[i][c] * inverse_mass[c] * normal[j][c];
        star[i][j] -= normal[i][c] * inverse_mass[c] * slide[j][c] * 0.3 * slip[j];
      }
      if (c < 2) b[i] += normal[i][c] * 10.0 * along[c];
    }
  return absolute<2>(s, star, b);
}

TEST(Hlcp, FindsThreeSolutions) {
  const Hlcp<2> problem = rod_on_two_guides();
  EXPECT_EQ(answer(problem).status, Status::not_unique);
  const double both = 4.9082864029421594688;
  const double large = 10.596908009061298911;
  const double small = -0.59801028674709775307;
  const double expected[3][2] = {{both, both}, {small, large}, {large, small}};
  for (unsigned code = 0; code < 3; ++code) {
    const HlcpSolution<2> solution = answer(problem, code, {NotUnique::continue_along_signs});
    ASSERT_EQ(solution.status, Status::ok);
    EXPECT_EQ(solution.uniqueness, Uniqueness::refuted);
    EXPECT_NEAR(solution.x[0], expected[code][0], 1e-12);
    EXPECT_NEAR(solution.x[1], expected[code][1], 1e-12);
  }
}

TEST(Hlcp, RefusesRankLostToRounding) {
  // Three contacts on one straight guide, in numbers that are no fractions of two: S = N N' of rank two.
  Matrix<3> s;
  const double lever[3] = {-0.3, 0.1, 0.7};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s[i][j] = 1.0 / 3.0 + lever[i] * lever[j] / 0.7;
  const Vector<3> b = {1.0 / 3.0 - 0.03, 1.0 / 3.0 + 0.01, 1.0 / 3.0 + 0.07};
  const HlcpSolution<3> solution = answer(absolute<3>(s, {}, b));
  EXPECT_TRUE(solution.status == Status::singular_constraints || solution.status == Status::not_unique)
      << name(solution.status);
}

TEST(Hlcp, NeverClaimsASingleSolutionOfTwoThatAreClose) {
  // Found beside the exact oracle: x_0 = +-2^-30, the others alike; 2^-30 of the largest is within the window of ties.
  const double large = 0x1p30;
  const Hlcp<5> problem = {
      {{-large, 1, 0, 0, 0}, {0, 0, 0, -1, 0}, {0, -1, 0, -1, -1}, {0, 1, 0, 0, -1}, {0, 1, 1, 0, 0}},
      {{large, 1, 0, 0, 0}, {0, 0, 0, -1, 0}, {0, -1, -1, -1, -1}, {0, 0, 0, 1, -1}, {0, 1, 0, 0, 0}},
      {0, 0, 1, 0, 1}};
  const HlcpSolution<5> solution = answer(problem);
  EXPECT_NE(solution.uniqueness, Uniqueness::single) << name(solution.status);
  EXPECT_NE(solution.uniqueness, Uniqueness::certified) << name(solution.status);
}

TEST(Hlcp, EnumeratesWhatIterationCannotSolveAboveOrderFour) {
  // Five equations 2u - 3|u| = r: no solution if any r is positive, 2^5 if all are negative.
  Hlcp<5> problem = {};
  for (int k = 0; k < 5; ++k) {
    problem.plus[k][k] = -1.0;
    problem.minus[k][k] = 5.0;
    problem.b[k] = -1.0;
  }
  problem.b[3] = 1.0;
  EXPECT_EQ(answer(problem).status, Status::no_solution);
  HlcpOptions few;
  few.max_solves = 10;
  EXPECT_EQ(answer(problem, 0, few).status, Status::solve_limit);
  EXPECT_LE(answer(problem, 0, few).solves, 10);
  for (int j = 0; j < 5; ++j) problem.plus[3][j] = problem.minus[3][j] = 0.0;
  EXPECT_EQ(answer(problem).status, Status::no_solution);
  problem.b[3] = 0.0;
  EXPECT_EQ(answer(problem).status, Status::singular_constraints);
}

template <int N>
void expect_enumeration_cut_short() {
  // As above; the equation without solution is the last, which may flip once, so that enumeration is reached.
  Hlcp<N> problem = {};
  for (int k = 0; k < N; ++k) {
    problem.plus[k][k] = -1.0;
    problem.minus[k][k] = 5.0;
    problem.b[k] = k == N - 1 ? 1.0 : -1.0;
  }
  HlcpOptions options;
  for (const int limit : {2, 50, 300}) {
    options.max_solves = limit;
    HlcpSolution<N> bounded = start<N>(0);
    slideway::solve(problem, static_cast<int>(N), bounded, options);
    for (const HlcpSolution<N>& solution : {answer(problem, 0, options), bounded}) {
      EXPECT_EQ(solution.status, Status::solve_limit) << name(solution.status);
      EXPECT_EQ(solution.solves, limit);
    }
  }
  // x_k = 1, and nothing more than that is known: the start is singular, and 300 patterns of 2^N are few.
  for (int k = 0; k < N; ++k) {
    problem.plus[k][k] = problem.b[k] = 1.0;
    problem.minus[k][k] = k == N - 1 ? 0.0 : 2.0;
  }
  const HlcpSolution<N> found = answer(problem, std::uint64_t{1} << (N - 1), options);
  EXPECT_EQ(found.uniqueness, Uniqueness::unproven) << name(found.uniqueness);
  expect_residual(problem, found);
}

TEST(Hlcp, ClaimsNothingFromAnEnumerationCutShort) {
  expect_enumeration_cut_short<31>();
  expect_enumeration_cut_short<32>();
  expect_enumeration_cut_short<33>();
  expect_enumeration_cut_short<63>();
  expect_enumeration_cut_short<64>();
}

// ---- the tiny world, complete: an exact reference that shares no formulation with the kernel. The solutions with
// signs in one orthant are the polyhedron {W(s) x = b, s x >= 0}; Fourier-Motzkin elimination projects it onto each
// axis.

using Inequality = std::vector<long long>;  // a_0 x_0 + ... + a_(n-1) x_(n-1) >= a_n

long long checked(bool overflow, long long value) {
  if (overflow) throw std::overflow_error("the reference needs more than 64 bits");
  return value;
}

long long times(long long a, long long b) {
  long long r = 0;
  const bool overflow = __builtin_mul_overflow(a, b, &r);
  return checked(overflow, r);
}

long long minus(long long a, long long b) {
  long long r = 0;
  const bool overflow = __builtin_sub_overflow(a, b, &r);
  return checked(overflow, r);
}

Inequality reduced(Inequality row) {
  long long divisor = 0;
  for (const long long value : row) divisor = std::gcd(divisor, value);
  if (divisor > 1)
    for (long long& value : row) value /= divisor;
  return row;
}

std::set<Inequality> without(const std::set<Inequality>& rows, int k) {
  std::set<Inequality> result;
  for (const Inequality& row : rows)
    if (row[k] == 0) result.insert(row);
  for (const Inequality& p : rows)
    for (const Inequality& q : rows) {
      if (p[k] <= 0 || q[k] >= 0) continue;
      Inequality row(p.size());
      for (std::size_t i = 0; i < p.size(); ++i) row[i] = minus(times(p[i], -q[k]), times(q[i], -p[k]));
      result.insert(reduced(row));
    }
  return result;
}

enum class Extent { none, point, more };

struct Shadow {
  Extent extent;
  std::pair<long long, long long> value;  // numerator, denominator of the point
};

Shadow shadow(std::set<Inequality> rows, int n, int axis) {
  for (int k = 0; k < n; ++k)
    if (k != axis) rows = without(rows, k);
  std::pair<long long, long long> low = {0, 0};
  std::pair<long long, long long> high = {0, 0};
  for (const Inequality& row : rows) {
    const long long a = row[axis];
    const long long c = row[n];
    if (a == 0 && c > 0) return {Extent::none, {}};
    if (a > 0 && (low.second == 0 || times(c, low.second) > times(low.first, a))) low = {c, a};
    if (a < 0 && (high.second == 0 || times(-c, high.second) < times(high.first, -a))) high = {-c, -a};
  }
  if (low.second == 0 || high.second == 0) return {Extent::more, {}};
  const long long difference = minus(times(low.first, high.second), times(high.first, low.second));
  if (difference > 0) return {Extent::none, {}};
  const long long divisor = std::gcd(low.first, low.second);
  return {difference == 0 ? Extent::point : Extent::more, {low.first / divisor, low.second / divisor}};
}

template <int N>
struct Integers {
  long long plus[N][N];
  long long minus[N][N];
  long long b[N];
};

template <int N>
struct Truth {
  Extent solutions;
  std::vector<std::pair<long long, long long>> x;
  bool w_property;
};

template <int N>
long long determinant(const long long (&w)[N][N]) {
  std::array<int, N> column;
  std::iota(column.begin(), column.end(), 0);
  long long sum = 0;
  do {
    long long term = 1;
    for (int i = 0; i < N; ++i) term = times(term, w[i][column[i]]);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < i; ++j)
        if (column[j] > column[i]) term = -term;
    sum = minus(sum, -term);
  } while (std::next_permutation(column.begin(), column.end()));
  return sum;
}

template <int N>
Truth<N> truth(const Integers<N>& problem) {
  std::set<std::vector<std::pair<long long, long long>>> points;
  std::set<int> signs;
  bool more = false;
  for (int code = 0; code < (1 << N); ++code) {
    long long w[N][N];
    std::set<Inequality> rows;
    for (int i = 0; i < N; ++i) {
      Inequality row(N + 1);
      for (int j = 0; j < N; ++j) row[j] = w[i][j] = ((code >> j) & 1) != 0 ? problem.minus[i][j] : problem.plus[i][j];
      row[N] = problem.b[i];
      rows.insert(reduced(row));
      for (long long& value : row) value = -value;
      rows.insert(reduced(row));
      Inequality sign(N + 1);
      sign[i] = ((code >> i) & 1) != 0 ? -1 : 1;
      rows.insert(sign);
    }
    const long long det = determinant<N>(w);
    signs.insert(det > 0 ? 1 : (det < 0 ? -1 : 0));
    std::vector<std::pair<long long, long long>> point;
    bool none = false;
    bool thick = false;
    for (int k = 0; k < N && !none; ++k) {
      const Shadow s = shadow(rows, N, k);
      none = s.extent == Extent::none;
      thick = thick || s.extent == Extent::more;
      point.push_back(s.value);
    }
    if (none) continue;
    more = more || thick;
    points.insert(point);
  }
  const bool w_property = signs.size() == 1 && *signs.begin() != 0;
  if (points.empty()) return {Extent::none, {}, w_property};
  if (more || points.size() > 1) return {Extent::more, {}, w_property};
  return {Extent::point, *points.begin(), w_property};
}

template <int N>
std::string text(const Integers<N>& problem) {
  std::string line;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) line += std::to_string(problem.plus[i][j]) + " ";
    line += "| ";
    for (int j = 0; j < N; ++j) line += std::to_string(problem.minus[i][j]) + " ";
    line += "| " + std::to_string(problem.b[i]) + (i + 1 < N ? " ; " : "");
  }
  return line;
}

/// The kernel's answer from every start is the truth, with the same bits.
template <int N>
void expect_truth(const Integers<N>& integers) {
  const Truth<N> expected = truth<N>(integers);
  Hlcp<N> problem;
  for (int i = 0; i < N; ++i) {
    problem.b[i] = static_cast<double>(integers.b[i]);
    for (int j = 0; j < N; ++j) {
      problem.plus[i][j] = static_cast<double>(integers.plus[i][j]);
      problem.minus[i][j] = static_cast<double>(integers.minus[i][j]);
    }
  }
  const HlcpSolution<N> first = answer(problem);
  for (unsigned code = 0; code < (1U << N); ++code) {
    const HlcpSolution<N> solution = answer(problem, code);
    const Status status = expected.solutions == Extent::none    ? Status::no_solution
                          : expected.solutions == Extent::point ? Status::ok
                                                                : Status::not_unique;
    ASSERT_EQ(name(solution.status), std::string(name(status))) << text<N>(integers);
    if (status != Status::ok) continue;
    ASSERT_EQ(solution.uniqueness, expected.w_property ? Uniqueness::certified : Uniqueness::single)
        << text<N>(integers);
    ASSERT_TRUE(same_bits(solution, first)) << text<N>(integers) << " from " << code;
    for (int k = 0; k < N; ++k) {
      const double x = static_cast<double>(expected.x[k].first) / static_cast<double>(expected.x[k].second);
      ASSERT_NEAR(solution.x[k], x, 1e-13 * (1.0 + std::fabs(x))) << text<N>(integers);
      ASSERT_EQ(solution.sign[k], solution.x[k] < 0.0 ? -1 : 1);
    }
  }
}

TEST(Hlcp, DecidesEveryProblemOfOrderOneOverMinusOneZeroOne) {
  for (long long p = -1; p <= 1; ++p)
    for (long long m = -1; m <= 1; ++m)
      for (long long b = -1; b <= 1; ++b) expect_truth<1>({{{p}}, {{m}}, {b}});
}

TEST(Hlcp, DecidesEveryProblemOfOrderTwoOverMinusOneZeroOne) {
  for (int code = 0; code < 59049; ++code) {
    long long v[10];
    int rest = code;
    for (long long& value : v) {
      value = rest % 3 - 1;
      rest /= 3;
    }
    expect_truth<2>({{{v[0], v[1]}, {v[2], v[3]}}, {{v[4], v[5]}, {v[6], v[7]}}, {v[8], v[9]}});
    if (HasFatalFailure()) return;
  }
}

/// Integers in [-range, range]; with planted zeros in the solution, so that signs are undetermined.
template <int N>
Integers<N> sample(std::mt19937_64& random, int range, bool is_lcp, bool planted) {
  const auto draw = [&] { return static_cast<long long>(random() % static_cast<unsigned>(2 * range + 1)) - range; };
  Integers<N> problem;
  long long x[N];
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      problem.plus[i][j] = is_lcp ? (i == j ? 1 : 0) : draw();
      problem.minus[i][j] = planted ? problem.plus[i][j] + draw() / 3 : draw();
    }
    problem.b[i] = draw();
    x[i] = random() % 2 == 0 ? 0 : draw();
  }
  for (int i = 0; i < N && planted; ++i) {
    problem.b[i] = 0;
    for (int j = 0; j < N; ++j) problem.b[i] += (x[j] < 0 ? problem.minus[i][j] : problem.plus[i][j]) * x[j];
  }
  return problem;
}

TEST(Hlcp, DecidesSampledProblemsOfOrderTwoToFour) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 400 && !HasFatalFailure(); ++round) {
    expect_truth<2>(sample<2>(random, 9, false, round % 2 == 0));
    expect_truth<3>(sample<3>(random, 1, true, false));
    expect_truth<3>(sample<3>(random, 1, false, false));
    expect_truth<3>(sample<3>(random, 6, false, round % 2 == 0));
    if (round % 10 == 0) expect_truth<4>(sample<4>(random, 3, false, round % 20 == 0));
  }
}

// ---- bits

/// Dyadic problems S = N N' + D, S* weak, with zeros planted in the solution.
template <int N>
Hlcp<N> dyadic(std::mt19937_64& random, bool planted) {
  const auto draw = [&] { return static_cast<double>(static_cast<int>(random() % 33) - 16) / 8.0; };
  Hlcp<N> problem;
  double x[N];
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      const double s = draw() + (i == j ? 3.0 * N : 0.0);
      const double star = draw() / 4.0;
      problem.plus[i][j] = s + star;
      problem.minus[i][j] = s - star;
    }
    x[i] = random() % 3 == 0 ? 0.0 : draw();
    problem.b[i] = draw();
  }
  for (int i = 0; i < N && planted; ++i) {
    problem.b[i] = 0.0;
    for (int j = 0; j < N; ++j) problem.b[i] += (x[j] < 0.0 ? problem.minus[i][j] : problem.plus[i][j]) * x[j];
  }
  return problem;
}

template <int N>
void expect_bits_independent_of_start(int rounds) {
  std::mt19937_64 random(N);
  for (int round = 0; round < rounds; ++round) {
    const Hlcp<N> problem = dyadic<N>(random, round % 2 == 0);
    const HlcpSolution<N> first = answer(problem);
    ASSERT_EQ(first.uniqueness, Uniqueness::certified);
    for (unsigned code = 1; code < (1U << N); ++code)
      ASSERT_TRUE(same_bits(answer(problem, code), first)) << "round " << round << " from " << code;
    HlcpSolution<N> bounded = start<N>(5);
    slideway::solve(problem, static_cast<int>(N), bounded);
    ASSERT_TRUE(same_bits(bounded, first)) << "fixed and bounded order, round " << round;
  }
}

TEST(Hlcp, GivesTheSameBitsFromEveryStart) {
  expect_bits_independent_of_start<1>(200);
  expect_bits_independent_of_start<2>(500);
  expect_bits_independent_of_start<3>(300);
  expect_bits_independent_of_start<4>(300);
  expect_bits_independent_of_start<5>(200);
  expect_bits_independent_of_start<7>(50);
}

/// Rows times powers of two up to 2^+-rows, the right side up to 2^+-right more.
template <int N>
void expect_scaling_invariance(int rounds, int rows = 30, int right = 20) {
  std::mt19937_64 random(100 + N);
  const auto draw = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) - most; };
  for (int round = 0; round < rounds; ++round) {
    const Hlcp<N> problem = dyadic<N>(random, round % 2 == 0);
    Hlcp<N> scaled = problem;
    const int all = draw(right);
    for (int i = 0; i < N; ++i) {
      const int power = draw(rows);
      for (int j = 0; j < N; ++j) {
        scaled.plus[i][j] = std::ldexp(problem.plus[i][j], power);
        scaled.minus[i][j] = std::ldexp(problem.minus[i][j], power);
      }
      scaled.b[i] = std::ldexp(problem.b[i], power + all);
    }
    const HlcpSolution<N> first = answer(problem, 3);
    const HlcpSolution<N> second = answer(scaled, 3);
    ASSERT_EQ(first.status, second.status);
    if (rows <= 30) {  // else some are scaled back first
      EXPECT_EQ(first.solves, second.solves);
    }
    for (int k = 0; k < N; ++k) ASSERT_EQ(second.x[k], std::ldexp(first.x[k], all)) << "round " << round;
  }
}

TEST(Hlcp, GivesTheSameBitsWhenRowsOrTheRightSideAreScaledByPowersOfTwo) {
  expect_scaling_invariance<1>(100);
  expect_scaling_invariance<2>(300);
  expect_scaling_invariance<3>(300);
  expect_scaling_invariance<4>(200);
  expect_scaling_invariance<6>(200);
  expect_scaling_invariance<9>(100);
}

TEST(Hlcp, GivesTheSameBitsWhereProductsWouldUnderflow) {
  expect_scaling_invariance<1>(1000, 190, 650);
  expect_scaling_invariance<2>(1000, 190, 650);
  expect_scaling_invariance<3>(3000, 190, 650);
  expect_scaling_invariance<4>(3000, 190, 650);
  expect_scaling_invariance<6>(300, 190, 650);
}

/// Columns that nearly depend on each other, so that the first x is refined; A- has nothing to do with A+.
Hlcp<5> nearly_dependent(std::mt19937_64& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  Hlcp<5> problem = {};
  const double gap = std::ldexp(1.0, -36 - static_cast<int>(random() % 14));
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      problem.plus[i][j] = number(random);
      problem.minus[i][j] = number(random);
    }
  const int last = static_cast<int>(random() % 5);
  double x[5];
  for (int j = 0; j < 5; ++j) {
    double sum = gap * number(random);
    for (int i = 0; i < 5; ++i) sum += i == last ? 0 : problem.plus[i][j] * ((i * 7 + 3) % 5 - 2);
    problem.plus[last][j] = sum;
    x[j] = std::ldexp(0.5 + 0.5 * std::fabs(number(random)), -static_cast<int>(random() % 19));
  }
  for (int i = 0; i < 5; ++i) {
    long double sum = 0;
    for (int j = 0; j < 5; ++j) sum += static_cast<long double>(problem.plus[i][j]) * x[j];
    problem.b[i] = static_cast<double>(sum);
  }
  return problem;
}

TEST(Hlcp, TakesTheSignsThatRefinementLeaves) {
  std::mt19937_64 random(3);
  int solved = 0;
  for (int round = 0; round < 40000; ++round) {
    const Hlcp<5> problem = nearly_dependent(random);
    const HlcpSolution<5> solution = answer(problem);
    if (solution.status != Status::ok) continue;
    ++solved;
    for (int k = 0; k < 5; ++k) EXPECT_EQ(solution.sign[k], solution.x[k] < 0 ? -1 : 1) << round;
    ASSERT_TRUE(slideway::hlcp_detail::is_answer(problem, 5, solution)) << round;
  }
  EXPECT_GT(solved, 30000);
}

TEST(Hlcp, GivesTheSameBitsForCapacityBeyondTheOrder) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 200; ++round) {
    const Hlcp<5> problem = dyadic<5>(random, round % 2 == 0);
    const HlcpSolution<5> first = answer(problem, 9);
    Hlcp<8> wide;
    HlcpSolution<8> solution = start<8>(9);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) wide.plus[i][j] = wide.minus[i][j] = wide.b[i] = nan_value;
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 5; ++j) {
        wide.plus[i][j] = problem.plus[i][j];
        wide.minus[i][j] = problem.minus[i][j];
      }
      wide.b[i] = problem.b[i];
    }
    slideway::solve(wide, 5, solution);
    ASSERT_EQ(solution.status, first.status);
    ASSERT_EQ(std::memcmp(solution.x, first.x, sizeof first.x), 0);
  }
}

// ---- the border of what doubles can hold

template <int N>
void expect_invalid_wherever(double bad, int stride = 1) {
  std::mt19937_64 random(4);
  const Hlcp<N> good = dyadic<N>(random, false);
  for (int i = 0; i < N; i += stride)
    for (int j = 0; j < 2 * N + 1; j += stride) {
      Hlcp<N> problem = good;
      (j < N ? problem.plus[i][j] : j < 2 * N ? problem.minus[i][j - N] : problem.b[i]) = bad;
      for (unsigned code = 0; code < (1U << std::min(N, 3)); ++code)
        ASSERT_EQ(answer(problem, code).status, Status::invalid_input) << i << " " << j;
    }
}

TEST(Hlcp, RefusesWhatIsNotFinite) {
  for (const double bad : {nan_value, infinity, -infinity}) {
    expect_invalid_wherever<1>(bad);
    expect_invalid_wherever<2>(bad);
    expect_invalid_wherever<3>(bad);
    expect_invalid_wherever<6>(bad);
    expect_invalid_wherever<17>(bad);
    expect_invalid_wherever<64>(bad, 16);
  }
}

template <int N>
void expect_solved_or_refused_at(double row, double right) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 20; ++round) {
    Hlcp<N> problem = dyadic<N>(random, round % 2 == 0);
    const HlcpSolution<N> plain = answer(problem);
    for (int i = 0; i < N; ++i) {
      const double factor = i % 2 == 0 ? row : 1.0 / row;
      for (int j = 0; j < N; ++j) {
        problem.plus[i][j] *= factor;
        problem.minus[i][j] *= factor;
      }
      problem.b[i] *= factor * right;
    }
    const HlcpSolution<N> solution = answer(problem, 1);
    if (solution.status != Status::ok) {
      EXPECT_EQ(solution.status, Status::inaccurate);
      continue;
    }
    for (int k = 0; k < N; ++k) {
      ASSERT_TRUE(std::isfinite(solution.x[k]));
      ASSERT_NEAR(solution.x[k] / right, plain.x[k], 1e-12) << row << " " << right;
    }
  }
}

TEST(Hlcp, SolvesOrRefusesExtremeScales) {
  for (const double row : {1e-300, 1e-160, 1e-100, 1.0, 1e100, 1e150, 1e300})
    for (const double right : {1e-150, 1.0, 1e150}) {
      if (row * 1e3 * right > 1e305 || 1e3 / row * right > 1e305) continue;
      if (row / 1e3 * right < 1e-290 || right / row / 1e3 < 1e-290) continue;
      expect_solved_or_refused_at<1>(row, right);
      expect_solved_or_refused_at<2>(row, right);
      expect_solved_or_refused_at<3>(row, right);
      expect_solved_or_refused_at<6>(row, right);
    }
}

TEST(Hlcp, RefusesASolutionBeyondTheRangeOfDoubles) {
  const HlcpSolution<1> huge = answer(hlcp<1>({{{1e-300}}}, {{{1e-300}}}, {1e300}));
  EXPECT_EQ(huge.status, Status::inaccurate);
  const HlcpSolution<1> tiny = answer(hlcp<1>({{{1e300}}}, {{{1e300}}}, {1e-300}));
  EXPECT_EQ(tiny.status, Status::inaccurate);
  Hlcp<2> problem = hlcp<2>({{{3e-200, 0.0}, {0.0, 3.0}}}, {{{3e-200, 0.0}, {0.0, 3.0}}}, {1e-310, 1.0});
  const HlcpSolution<2> solution = answer(problem);
  EXPECT_TRUE(solution.status == Status::inaccurate ||
              (solution.status == Status::ok && std::fabs(solution.x[0] * 3e110 - 1.0) < 1e-2))
      << name(solution.status);
}

TEST(Hlcp, KeepsAllDigitsAcrossMassRatios) {
  // Columns in units that differ by 1e12 to 1e100: componentwise well conditioned, so componentwise accurate.
  std::mt19937_64 random(6);
  for (const double ratio : {1e4, 1e12, 1e50, 1e100}) {
    for (int round = 0; round < 50; ++round) {
      const Hlcp<4> plain = dyadic<4>(random, false);
      Hlcp<4> problem = plain;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          const double factor = j % 2 == 0 ? 1.0 : std::exp2(std::round(std::log2(1.0 / ratio)));
          problem.plus[i][j] *= factor;
          problem.minus[i][j] *= factor;
        }
      const HlcpSolution<4> expected = answer(plain);
      const HlcpSolution<4> solution = answer(problem);
      ASSERT_EQ(solution.status, Status::ok) << name(solution.status) << " " << ratio;
      for (int j = 0; j < 4; ++j) {
        const double factor = j % 2 == 0 ? 1.0 : std::exp2(std::round(std::log2(1.0 / ratio)));
        ASSERT_NEAR(solution.x[j] * factor / expected.x[j], 1.0, 1e-12);
      }
    }
  }
}

TEST(Hlcp, SolvesTiesOfIllConditionedProblems) {
  // The last row of N almost repeats the first; components planted at zero come out as rounding errors, magnified.
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 500; ++round) {
    double rows[4][6];
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 6; ++k) rows[i][k] = i < 3 ? uniform(random) : rows[0][k] + 1e-3 * uniform(random);
    Matrix<4> s = {};
    Matrix<4> star = {};
    Vector<4> b = {};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 6; ++k) s[i][j] += rows[i][k] * rows[j][k];
        star[i][j] = 1e-9 * uniform(random);
      }
    Hlcp<4> problem = absolute<4>(s, star, b);
    for (int j = 0; j < 4; ++j) {
      const double x = random() % 2 == 0 ? 0.0 : uniform(random);
      for (int i = 0; i < 4; ++i) problem.b[i] += (x < 0.0 ? problem.minus[i][j] : problem.plus[i][j]) * x;
    }
    const HlcpSolution<4> first = answer(problem);
    expect_residual(problem, first);
    EXPECT_EQ(first.uniqueness, Uniqueness::certified);
    for (unsigned code = 1; code < 16; ++code) ASSERT_TRUE(same_bits(answer(problem, code), first)) << round;
  }
}

// ---- orders and the matrix border

TEST(Hlcp, SolvesOrdersZeroToSixtyFour) {
  Hlcp<64> problem = {};
  HlcpSolution<64> solution = start<64>(0x5555);
  for (int n : {-1, 65}) {
    slideway::solve(problem, n, solution);
    EXPECT_EQ(solution.status, Status::invalid_input);
  }
  slideway::solve(problem, 0, solution);
  EXPECT_EQ(solution.status, Status::ok);
  EXPECT_EQ(solution.uniqueness, Uniqueness::certified);
  std::mt19937_64 random(7);
  const Hlcp<64> full = dyadic<64>(random, false);
  for (int n = 1; n <= 64; ++n) {
    solution = start<64>(0x5555);
    slideway::solve(full, n, solution);
    ASSERT_EQ(solution.status, Status::ok) << n;
    EXPECT_LE(solution.residual, 4 * (n + 1) * 0x1p-53);
  }
  expect_residual<64>(full, answer(full, 0x123456789abcdef0));
}

/// As dyadic(); x_k = +-(1 + k/8), negative where `code` has a bit.
template <int N>
Hlcp<N> planted(std::mt19937_64& random, std::uint64_t code) {
  Hlcp<N> problem = dyadic<N>(random, false);
  for (double& b : problem.b) b = 0.0;
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) {
      const bool negative = ((code >> j) & 1) != 0;
      problem.b[i] += (negative ? -problem.minus[i][j] : problem.plus[i][j]) * (1.0 + j / 8.0);
    }
  return problem;
}

template <int N>
void expect_planted_solution() {
  std::mt19937_64 random(N);
  const std::uint64_t right = random();
  const Hlcp<N> problem = planted<N>(random, right);
  const HlcpSolution<N> first = answer(problem, right);
  EXPECT_EQ(first.status, Status::ok);
  EXPECT_EQ(first.uniqueness, Uniqueness::certified);
  EXPECT_EQ(first.solves, 1);
  for (int k = 0; k < N; ++k) {
    EXPECT_EQ(first.sign[k], ((right >> k) & 1) != 0 ? -1 : 1);
    EXPECT_NEAR(first.x[k] * first.sign[k], 1.0 + k / 8.0, 1e-13);
  }
  for (const std::uint64_t wrong :
       {~right, std::uint64_t{0}, right ^ (std::uint64_t{1} << (N - 1)), right ^ 0xffffffff00000000}) {
    const HlcpSolution<N> solution = answer(problem, wrong);
    EXPECT_TRUE(same_bits(solution, first)) << name(solution.status);
    EXPECT_LE(solution.solves, 5) << "of iteration; flips would need one for each wrong sign";
  }
  HlcpSolution<N> bounded = start<N>(right);
  slideway::solve(problem, static_cast<int>(N), bounded);
  EXPECT_TRUE(same_bits(bounded, first));
}

TEST(Hlcp, FindsThePlantedSolutionFromRightAndWrongSigns) {
  expect_planted_solution<33>();
  expect_planted_solution<34>();
  expect_planted_solution<48>();
  expect_planted_solution<63>();
  expect_planted_solution<64>();
}

TEST(Hlcp, GivesTheSameBitsFromManyStartsOfLargeOrder) {
  std::mt19937_64 random(12);
  for (int round = 0; round < 10; ++round) {
    const Hlcp<64> problem = dyadic<64>(random, round % 2 == 0);
    const HlcpSolution<64> first = answer(problem);
    ASSERT_EQ(first.uniqueness, Uniqueness::certified);
    for (int other = 0; other < 20; ++other) ASSERT_TRUE(same_bits(answer(problem, random()), first)) << round;
  }
}

template <int N>
void expect_no_certificate_for_a_column_that_turns() {
  Hlcp<N> problem = {};
  for (int i = 0; i < N; ++i) {
    problem.plus[i][i] = problem.minus[i][i] = 1;
    problem.b[i] = 1;
  }
  problem.minus[0][0] = -1;  // |x_0| = 1
  const HlcpSolution<N> solution = answer(problem);
  ASSERT_EQ(solution.status, Status::ok);
  EXPECT_EQ(solution.uniqueness, Uniqueness::unproven);
  EXPECT_FALSE(solution.bounded);
}

TEST(Hlcp, CertifiesNothingAboveOrderFourWhereAColumnTurns) {
  expect_no_certificate_for_a_column_that_turns<5>();
  expect_no_certificate_for_a_column_that_turns<6>();
  expect_no_certificate_for_a_column_that_turns<17>();
}

TEST(Hlcp, FindsPivotsInEveryRow) {
  // With the rows turned upside down, every pivot is in the row that is last but k; what is eliminated is the same.
  std::mt19937_64 random(13);
  const std::uint64_t right = random();
  const Hlcp<64> problem = planted<64>(random, right);
  Hlcp<64> turned = problem;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      turned.plus[i][j] = problem.plus[63 - i][j];
      turned.minus[i][j] = problem.minus[63 - i][j];
    }
    turned.b[i] = problem.b[63 - i];
  }
  const HlcpSolution<64> solution = answer(turned, right);
  expect_residual(turned, solution);
  EXPECT_TRUE(same_bits(solution, answer(problem, right)));
}

TEST(Hlcp, KeepsTheSignsGivenWhenItScales) {
  // Rows this small are refused by the first trial; the second, scaled, has the signs given.
  std::mt19937_64 random(14);
  const std::uint64_t right = random();
  const Hlcp<64> problem = planted<64>(random, right);
  Hlcp<64> small = problem;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      small.plus[i][j] *= 0x1p-300;
      small.minus[i][j] *= 0x1p-300;
    }
    small.b[i] *= 0x1p-300;
  }
  const HlcpSolution<64> solution = answer(small, right);
  EXPECT_TRUE(same_bits(solution, answer(problem, right)));
  EXPECT_EQ(solution.solves, 2);
}

TEST(Hlcp, TakesAnythingButMinusOneForPlus) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 100; ++round) {
    const Hlcp<3> problem = dyadic<3>(random, true);
    HlcpSolution<3> odd = {};
    odd.sign[0] = 0;
    odd.sign[1] = 77;
    odd.sign[2] = -77;
    slideway::solve(problem, 3, odd);
    EXPECT_TRUE(same_bits(odd, answer(problem)));
  }
}

TEST(Hlcp, ReturnsNoNegativeZero) {
  for (unsigned code = 0; code < 4; ++code) {
    EXPECT_FALSE(std::signbit(answer(hlcp<1>({{{-1.0}}}, {{{-2.0}}}, {0.0}), code % 2).x[0]));
    const Matrix<2> matrix = {{{-2.0, 1.0}, {1.0, -2.0}}};
    for (const Vector<2>& b : {Vector<2>{0.0, -0.0}, Vector<2>{2.0, -1.0}}) {
      const HlcpSolution<2> solution = answer(hlcp<2>(matrix, matrix, b), code);
      ASSERT_EQ(solution.status, Status::ok);
      EXPECT_FALSE(solution.x[1] == 0.0 && std::signbit(solution.x[1]));
      EXPECT_EQ(solution.sign[1], 1);
    }
    const Matrix<3> three = {{{-2.0, 0.0, 0.0}, {0.0, -2.0, 0.0}, {0.0, 0.0, -2.0}}};
    const HlcpSolution<3> zero = answer(hlcp<3>(three, three, {0.0, 0.0, 0.0}), code);
    for (const double x : zero.x) EXPECT_FALSE(std::signbit(x));
  }
}

TEST(Hlcp, NeedsOneSolveFromTheRightSigns) {
  std::mt19937_64 random(9);
  const Hlcp<6> problem = dyadic<6>(random, false);
  HlcpSolution<6> solution = answer(problem);
  slideway::solve(problem, 6, solution);
  EXPECT_EQ(solution.solves, 1);
  EXPECT_EQ(solution.uniqueness, Uniqueness::certified);
}

TEST(Hlcp, SolvesEigenMatricesOfFixedAndBoundedSize) {
  std::mt19937_64 random(10);
  const Hlcp<3> problem = dyadic<3>(random, false);
  Eigen::Matrix3d plus;
  Eigen::Matrix3d minus;
  Eigen::Vector3d b;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      plus(i, j) = problem.plus[i][j];
      minus(i, j) = problem.minus[i][j];
    }
    b(i) = problem.b[i];
  }
  const HlcpSolution<3> expected = answer(problem);
  const auto fixed = solve_hlcp(plus, minus, b);
  EXPECT_EQ(fixed.status, Status::ok);
  using Bounded = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 20, 20>;
  using BoundedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 20, 1>;
  const signed char signs[3] = {-1, 1, -1};
  const auto bounded = solve_hlcp(Bounded(plus), Bounded(minus), BoundedVector(b), signs);
  EXPECT_EQ(bounded.status, Status::ok);
  ASSERT_EQ(bounded.x.size(), 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(fixed.x(k), expected.x[k]);
    EXPECT_EQ(bounded.x(k), expected.x[k]);
    EXPECT_EQ(fixed.sign[k], expected.sign[k]);
  }
  const auto block = solve_hlcp(plus.topLeftCorner<2, 2>(), minus.topLeftCorner<2, 2>(), b.head<2>());
  EXPECT_EQ(block.status, Status::ok);
}

TEST(Hlcp, RefusesEigenMatricesOfDifferentSizes) {
  using Bounded = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 32, 32>;
  using BoundedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 32, 1>;
  const Bounded three = Bounded::Identity(3, 3);
  const Bounded two = Bounded::Identity(2, 2);
  EXPECT_EQ(solve_hlcp(three, two, BoundedVector::Ones(3).eval()).status, Status::invalid_input);
  EXPECT_EQ(solve_hlcp(three, three, BoundedVector::Ones(2).eval()).status, Status::invalid_input);
  EXPECT_EQ(solve_hlcp(Bounded(3, 2), three, BoundedVector::Ones(3).eval()).status, Status::invalid_input);
  EXPECT_EQ(solve_hlcp(three, Bounded(2, 3), BoundedVector::Ones(3).eval()).status, Status::invalid_input);
  const auto empty = solve_hlcp(Bounded(0, 0), Bounded(0, 0), BoundedVector(0));
  EXPECT_EQ(empty.status, Status::ok);
  EXPECT_EQ(empty.x.size(), 0);
  const Bounded most = Bounded::Identity(32, 32);
  EXPECT_EQ(solve_hlcp(most, most, BoundedVector::Ones(32).eval()).status, Status::ok);
}

TEST(Hlcp, SolvesEigenMatricesUpToOrderSixtyFour) {
  std::mt19937_64 random(15);
  const std::uint64_t right = random();
  const Hlcp<64> problem = planted<64>(random, right);
  const HlcpSolution<64> expected = answer(problem, right);
  using Square = Eigen::Matrix<double, 64, 64, Eigen::RowMajor>;
  using Column = Eigen::Matrix<double, 64, 1>;
  const Eigen::Map<const Square> plus(&problem.plus[0][0]), minus(&problem.minus[0][0]);
  const Eigen::Map<const Column> b(problem.b);
  const auto fixed = solve_hlcp(plus, minus, b, expected.sign);
  EXPECT_EQ(fixed.status, Status::ok);
  EXPECT_EQ(fixed.solves, 1);
  using AnySquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const AnySquare> any_plus(plus.data(), 64, 64), any_minus(minus.data(), 64, 64);
  const Eigen::Map<const Eigen::VectorXd> any_b(problem.b, 64);
  const auto dynamic = solve_hlcp(any_plus, any_minus, any_b, expected.sign);
  EXPECT_EQ(dynamic.status, Status::ok);
  ASSERT_EQ(dynamic.x.size(), 64);
  EXPECT_EQ(std::memcmp(fixed.x.data(), expected.x, sizeof expected.x), 0);
  EXPECT_EQ(std::memcmp(dynamic.x.data(), expected.x, sizeof expected.x), 0);
  const std::vector<double> large(65 * 65);
  const Eigen::Map<const AnySquare> matrix(large.data(), 65, 65);
  const Eigen::Map<const Eigen::VectorXd> column(large.data(), 65);
  EXPECT_EQ(solve_hlcp(matrix, matrix, column).status, Status::invalid_input);
}

}  // namespace
