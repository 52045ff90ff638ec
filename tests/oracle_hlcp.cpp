// The exact HLCP: against methods that share nothing with it, properties of sets of solutions, textbook problems.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <slideway/oracle/hlcp.hpp>
#include <stdexcept>
#include <vector>

namespace {

using namespace slideway::oracle;
using Rows = std::vector<std::vector<long long>>;
using Row = std::vector<long long>;
using Points = std::set<Exact>;

struct Problem {
  int n;
  Rows plus, minus;
  Row b;
};

ExactHlcp exactly(const Problem& problem) { return exact_hlcp(problem.n, problem.plus, problem.minus, problem.b); }

Points points(const std::vector<Exact>& list) {
  Points set(list.begin(), list.end());
  EXPECT_EQ(set.size(), list.size()) << "a point is listed twice";
  return set;
}

// ---- The truth by Fourier-Motzkin elimination

/// a[0] x_0 + .. + a[n-1] x_(n-1) <= a[n], without common factor.
using Inequality = Row;
using System = std::set<Inequality>;

void add(System& system, Inequality one) {
  long long common = 0;
  for (const long long value : one) common = std::gcd(common, value);
  for (long long& value : one) value /= std::max(common, 1LL);
  system.insert(one);
}

System without(const System& system, std::size_t variable) {
  System result;
  for (const Inequality& above : system) {
    if (above[variable] == 0) result.insert(above);
    for (const Inequality& below : system) {
      if (above[variable] <= 0 || below[variable] >= 0) continue;
      Inequality sum(above.size());
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = above[k] * -below[variable] + below[k] * above[variable];
      add(result, sum);
    }
  }
  return result;
}

/// {x : W(s) x = b, s_j x_j >= 0}
System polyhedron(const Problem& problem, unsigned pattern) {
  System system;
  const auto n = static_cast<std::size_t>(problem.n);
  for (std::size_t i = 0; i < n; ++i) {
    Inequality most(n + 1), least(n + 1), sign(n + 1);
    for (std::size_t j = 0; j < n; ++j) most[j] = ((pattern >> j & 1) != 0 ? problem.minus : problem.plus)[i][j];
    most[n] = problem.b[i];
    for (std::size_t j = 0; j <= n; ++j) least[j] = -most[j];
    sign[i] = (pattern >> i & 1) != 0 ? 1 : -1;
    for (const Inequality& one : {most, least, sign}) add(system, one);
  }
  return system;
}

struct Interval {
  bool empty = false;
  std::optional<Rational> low, high;
};

/// The values of one variable in the set.
Interval shadow(System system, std::size_t n, std::size_t variable) {
  for (std::size_t other = 0; other < n; ++other)
    if (other != variable) system = without(system, other);
  Interval interval;
  for (const Inequality& one : system) {
    const long long a = one[variable], c = one[n];
    if (a == 0) {
      interval.empty = interval.empty || c < 0;
      continue;
    }
    const Rational bound = Rational(c) / a;
    std::optional<Rational>& end = a > 0 ? interval.high : interval.low;
    if (!end || (a > 0 ? bound < *end : bound > *end)) end = bound;
  }
  interval.empty = interval.empty || (interval.low && interval.high && *interval.low > *interval.high);
  return interval;
}

bool contains(const System& system, const Exact& x) {
  return std::all_of(system.begin(), system.end(), [&](const Inequality& one) {
    Rational sum = -one[x.size()];
    for (std::size_t k = 0; k < x.size(); ++k) sum += one[k] * x[k];
    return sum <= 0;
  });
}

struct Truth {
  Points isolated;
  bool continuum = false;
};

Truth truth(const Problem& problem) {
  Truth result;
  const auto n = static_cast<std::size_t>(problem.n);
  Points single;
  std::vector<System> many;
  for (unsigned pattern = 0; pattern < 1U << n; ++pattern) {
    const System system = polyhedron(problem, pattern);
    Exact x;
    bool empty = false;
    for (std::size_t k = 0; k < n && !empty; ++k) {
      const Interval values = shadow(system, n, k);
      empty = values.empty;
      if (values.low && values.low == values.high) x.push_back(*values.low);
    }
    if (empty) continue;
    if (x.size() == n)
      single.insert(x);
    else
      many.push_back(system);
  }
  for (const Exact& x : single)
    if (std::none_of(many.begin(), many.end(), [&](const System& system) { return contains(system, x); }))
      result.isolated.insert(x);
  result.continuum = !many.empty();
  return result;
}

long long determinant(const Rows& matrix) {
  if (matrix.empty()) return 1;
  long long sum = 0;
  for (std::size_t j = 0; j < matrix.size(); ++j) {
    Rows minor(matrix.begin() + 1, matrix.end());
    for (Row& row : minor) row.erase(row.begin() + static_cast<std::ptrdiff_t>(j));
    sum += (j % 2 == 0 ? 1 : -1) * matrix[0][j] * determinant(minor);
  }
  return sum;
}

Rows choose(const Problem& problem, unsigned pattern) {
  Rows w = problem.plus;
  for (std::size_t i = 0; i < w.size(); ++i)
    for (std::size_t j = 0; j < w.size(); ++j)
      if ((pattern >> j & 1) != 0) w[i][j] = problem.minus[i][j];
  return w;
}

bool all_of_one_sign(const Problem& problem) {
  const long long first = determinant(choose(problem, 0));
  for (unsigned pattern = 0; pattern < 1U << problem.n; ++pattern) {
    const long long other = determinant(choose(problem, pattern));
    if (other == 0 || (other > 0) != (first > 0)) return false;
  }
  return true;
}

// ---- Problems

enum class Form { lcp, hlcp };

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  long long in(int range) { return static_cast<long long>(random_() % static_cast<unsigned>(2 * range + 1)) - range; }
  Rows matrix(int n, int range) {
    Rows rows(static_cast<std::size_t>(n), Row(static_cast<std::size_t>(n)));
    for (Row& row : rows)
      for (long long& value : row) value = in(range);
    return rows;
  }
  Problem problem(int n, int range, Form form) {
    Problem problem{n, matrix(n, range), matrix(n, range), Row(static_cast<std::size_t>(n))};
    for (std::size_t i = 0; i < problem.b.size(); ++i) {
      problem.b[i] = in(range);
      for (std::size_t j = 0; form == Form::lcp && j < problem.b.size(); ++j) problem.plus[i][j] = i == j ? 1 : 0;
    }
    return problem;
  }

 private:
  std::mt19937 random_;
};

/// Tells what the problems were, since a test of singular ones is none without them.
struct Census {
  int none = 0, one = 0, several = 0, continuum = 0, mixed = 0, w_property = 0;

  void enter(const ExactAnswer& answer) {
    const Count count = answer.count();
    ++(count == Count::none ? none : count == Count::one ? one : count == Count::several ? several : continuum);
    mixed += !answer.isolated.empty() && !answer.continuum.empty();
    w_property += answer.w_property;
  }
};

void expect_solutions(const ExactHlcp& problem, const ExactAnswer& answer) {
  for (const auto* list : {&answer.isolated, &answer.continuum})
    for (const Exact& x : *list) EXPECT_EQ(residual(problem, x), 0);
}

void expect_truth(const Problem& problem, Census& census) {
  const ExactHlcp exact = exactly(problem);
  const ExactAnswer answer = solve(exact);
  const Truth expected = truth(problem);
  ASSERT_EQ(points(answer.isolated), expected.isolated);
  ASSERT_EQ(!answer.continuum.empty(), expected.continuum);
  ASSERT_EQ(answer.w_property, all_of_one_sign(problem));
  ASSERT_EQ(has_w_property(exact), answer.w_property);
  expect_solutions(exact, answer);
  const ExactAnswer counts = solve(exact, Want::counts);
  ASSERT_EQ(counts.isolated.size(), answer.isolated.size());
  ASSERT_EQ(counts.continuum.size(), answer.continuum.size());
  ASSERT_EQ(counts.w_property, answer.w_property);
  census.enter(answer);
}

TEST(OracleHlcp, KnowsEveryProblemOfOrderOne) {
  Census census;
  for (long long plus = -2; plus <= 2; ++plus)
    for (long long minus = -2; minus <= 2; ++minus)
      for (long long b = -2; b <= 2; ++b) expect_truth({1, {{plus}}, {{minus}}, {b}}, census);
  EXPECT_EQ(census.w_property, 2 * 2 * 2 * 5);
  EXPECT_EQ(census.continuum, 9) << "A+ = 0 or A- = 0, and b = 0";
}

TEST(OracleHlcp, AgreesWithFourierAndMotzkin) {
  Draw draw(1);
  Census census;
  for (int round = 0; round < 6000 && !HasFatalFailure(); ++round) {
    for (const Form form : {Form::lcp, Form::hlcp}) expect_truth(draw.problem(2, 1 + round % 3, form), census);
    if (round % 3 == 0) expect_truth(draw.problem(3, 1, round % 2 == 0 ? Form::lcp : Form::hlcp), census);
    if (round % 15 == 0) expect_truth(draw.problem(3, 3, Form::hlcp), census);
  }
  for (const int seen : {census.none, census.one, census.several, census.continuum, census.mixed, census.w_property})
    EXPECT_GE(seen, 50);
}

/// Solutions of all patterns by Cramer's rule; nothing if a determinant is zero.
std::optional<Points> cramer(const Problem& problem) {
  Points solutions;
  for (unsigned pattern = 0; pattern < 1U << problem.n; ++pattern) {
    const Rows w = choose(problem, pattern);
    const long long whole = determinant(w);
    if (whole == 0) return std::nullopt;
    Exact x;
    for (std::size_t k = 0; k < w.size(); ++k) {
      Rows part = w;
      for (std::size_t i = 0; i < w.size(); ++i) part[i][k] = problem.b[i];
      x.push_back(Rational(determinant(part)) / whole);
      if ((pattern >> k & 1) != 0 ? x.back() > 0 : x.back() < 0) break;
    }
    if (x.size() == w.size() && ((pattern >> (w.size() - 1) & 1) != 0 ? x.back() <= 0 : x.back() >= 0))
      solutions.insert(x);
  }
  return solutions;
}

TEST(OracleHlcp, AgreesWithCramer) {
  Draw draw(2);
  Census census;
  for (int round = 0; round < 400; ++round) {
    Problem problem = draw.problem(4 + round % 2, 9, Form::hlcp);
    for (std::size_t i = 0; i < problem.b.size() && round % 4 < 2; ++i)
      for (std::size_t j = 0; j < problem.b.size(); ++j)
        problem.minus[i][j] = problem.plus[i][j] + (i == j ? 8 : problem.minus[i][j] / 4);
    const std::optional<Points> solutions = cramer(problem);
    if (!solutions) continue;
    const ExactAnswer answer = solve(exactly(problem));
    ASSERT_EQ(points(answer.isolated), *solutions);
    ASSERT_TRUE(answer.continuum.empty());
    ASSERT_EQ(answer.w_property, all_of_one_sign(problem));
    census.enter(answer);
  }
  for (const int seen : {census.none, census.one, census.several, census.w_property}) EXPECT_GE(seen, 5);
}

// ---- Properties

/// Two problems that do not touch, as one.
Problem side_by_side(const Problem& a, const Problem& b) {
  Problem both{a.n + b.n, {}, {}, a.b};
  both.b.insert(both.b.end(), b.b.begin(), b.b.end());
  const auto join = [&](const Rows& first, const Rows& second) {
    Rows rows(both.b.size(), Row(both.b.size()));
    for (std::size_t i = 0; i < first.size(); ++i) std::copy(first[i].begin(), first[i].end(), rows[i].begin());
    for (std::size_t i = 0; i < second.size(); ++i)
      std::copy(second[i].begin(), second[i].end(), rows[i + first.size()].begin() + a.n);
    return rows;
  };
  both.plus = join(a.plus, b.plus);
  both.minus = join(a.minus, b.minus);
  return both;
}

/// Adds multiples of rows to others: the equations say the same.
void mix_rows(Problem& problem, Draw& draw) {
  for (std::size_t i = 0; i < problem.b.size(); ++i)
    for (std::size_t other = 0; other < problem.b.size(); ++other) {
      const long long factor = i == other ? 0 : draw.in(1);
      for (Rows* rows : {&problem.plus, &problem.minus})
        for (std::size_t j = 0; j < problem.b.size(); ++j) (*rows)[i][j] += factor * (*rows)[other][j];
      problem.b[i] += factor * problem.b[other];
    }
}

TEST(OracleHlcp, SolutionsOfSeparateProblemsCombine) {
  Draw draw(3);
  Census census;
  for (int round = 0; round < 3000; ++round) {
    const Problem a = draw.problem(1 + round % 2, 2, Form::hlcp), b = draw.problem(2 + round / 2 % 2, 1, Form::lcp);
    Problem both = side_by_side(a, b);
    mix_rows(both, draw);
    const ExactAnswer first = solve(exactly(a)), second = solve(exactly(b)), answer = solve(exactly(both));
    Points expected;
    for (const Exact& x : first.isolated)
      for (Exact all : second.isolated) {
        all.insert(all.begin(), x.begin(), x.end());
        expected.insert(all);
      }
    ASSERT_EQ(points(answer.isolated), expected);
    const auto any = [](const ExactAnswer& part) { return part.count() != Count::none; };
    const bool continuum = any(first) && any(second) && !(first.continuum.empty() && second.continuum.empty());
    ASSERT_EQ(!answer.continuum.empty(), continuum);
    ASSERT_EQ(answer.w_property, first.w_property && second.w_property);
    expect_solutions(exactly(both), answer);
    census.enter(answer);
  }
  for (const int seen : {census.none, census.one, census.several, census.continuum, census.mixed, census.w_property})
    EXPECT_GE(seen, 20);
}

// ---- Textbook problems

Rows murty(int n) {
  Rows m(static_cast<std::size_t>(n), Row(static_cast<std::size_t>(n)));
  for (std::size_t i = 0; i < m.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) m[i][j] = i == j ? 1 : 2;
  return m;
}

Rows transposed(const Rows& m) {
  Rows t = m;
  for (std::size_t i = 0; i < m.size(); ++i)
    for (std::size_t j = 0; j < m.size(); ++j) t[i][j] = m[j][i];
  return t;
}

Rows times(const Rows& a, const Rows& b) {
  Rows product(a.size(), Row(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a.size(); ++j)
      for (std::size_t k = 0; k < a.size(); ++k) product[i][j] += a[i][k] * b[k][j];
  return product;
}

ExactAnswer lcp(const Rows& m, const Row& q) { return solve(exact_lcp(static_cast<int>(q.size()), m, q)); }

void expect_one(const ExactAnswer& answer, const Exact& x, bool w_property) {
  ASSERT_EQ(answer.count(), Count::one);
  EXPECT_EQ(answer.isolated[0], x);
  EXPECT_EQ(answer.w_property, w_property);
}

// Murty, Computational complexity of complementary pivot methods, Math. Programming Study 7 (1978); Fathi, Math.
// Programming 17 (1979).
TEST(OracleHlcp, SolvesMurtysAndFathisProblems) {
  for (const int n : {1, 2, 3, 5, 8, 12}) {
    Row ones(static_cast<std::size_t>(n), -1), powers;
    for (int i = 1; i <= n; ++i) powers.push_back((1LL << i) - (2LL << n));
    Exact first(ones.size(), 1), last = first, down, up;
    first.front() = last.back() = -1;
    for (int i = 1; i <= n; ++i) {
      down.push_back(i == 1 ? powers[0] : (2LL << n) + (1LL << i) - 4);
      up.push_back(i == n ? -(1LL << n) : 1LL << i);
    }
    expect_one(lcp(murty(n), ones), first, true);
    expect_one(lcp(murty(n), powers), down, true);
    expect_one(lcp(transposed(murty(n)), ones), last, true);
    expect_one(lcp(transposed(murty(n)), powers), up, true);
    expect_one(lcp(times(murty(n), transposed(murty(n))), ones), first, true);
  }
}

// Kostreva, Direct algorithms for complementarity problems, thesis (1976); Ben Gharbia & Gilbert, Math. Programming 134
// (2012), has the c-cycle.
TEST(OracleHlcp, SolvesProblemsThatMakeIterationsCycle) {
  expect_one(lcp({{1, 2, 0}, {0, 1, 2}, {2, 0, 1}}, {-1, -1, -1}), Exact(3, Rational(-1, 3)), true);
  const Rational c(11, 10);
  std::vector<Exact> plus(3, Exact(3)), minus = plus;  // S + S* = 2 C, S - S* = 2 I
  for (std::size_t i = 0; i < 3; ++i) {
    plus[i][i] = 2;
    plus[i][(i + 2) % 3] = 2 * c;
    minus[i][i] = 2;
  }
  expect_one(solve(exact_hlcp(3, plus, minus, Exact(3, 2))), Exact(3, 1 / (1 + c)), true);
}

// Siconos, numerics/src/LCP/test/data: lcp_CPS_1 (there: Cottle, Pang & Stone, remark 4.1.14), lcp_CPS_4,
// lcp_Pang_isolated_sol_perturbed; Numerics/src/solverpack/test/MATRIX: murty1. Drake, solvers: TestMILPLCP, Cottle.
TEST(OracleHlcp, SolvesTextbookProblems) {
  const ExactAnswer line = lcp({{1, 1}, {1, 1}}, {-1, -1});
  EXPECT_EQ(line.count(), Count::continuum);
  EXPECT_TRUE(line.isolated.empty());
  EXPECT_EQ(points(line.continuum), (Points{{-1, 0}, {0, -1}})) << "z1 + z2 = 1";
  expect_one(lcp({{11, 0, 10, -1}, {0, 11, 10, -1}, {10, 10, 21, -1}, {1, 1, 1, 0}}, {50, 50, 10, -6}),
             {-2, -2, -2, -92}, false);
  const Rows pang = {{0, -1, -1}, {1, 0, 0}, {-1, 0, 0}};
  expect_one(lcp(pang, {0, -1, 1}), {-1, 0, 0}, false);
  EXPECT_EQ(lcp(pang, {-1, -10000, 10000}).count(), Count::none);
  expect_one(lcp({{1, -1, -1, -1}, {-1, 1, -1, -1}, {1, 1, 2, 0}, {1, 1, 0, 2}}, {3, 5, -9, -5}), {-2, -1, -3, -1},
             false);
  expect_one(lcp({{0, -1, 2}, {2, 0, -2}, {-1, 1, 0}}, {-3, 6, -1}), {2, -1, -3}, false);
}

TEST(OracleHlcp, CountsTheCornersOfACube) {
  for (int n = 0; n <= 12; n += 4) {  // w + z = 1: each x_k is 1 or -1
    Rows m(static_cast<std::size_t>(n), Row(static_cast<std::size_t>(n)));
    for (std::size_t k = 0; k < m.size(); ++k) m[k][k] = -1;
    EXPECT_EQ(points(lcp(m, Row(m.size(), 1)).isolated).size(), std::size_t{1} << n);
    EXPECT_EQ(lcp(m, Row(m.size(), -1)).count(), n == 0 ? Count::one : Count::none);
  }
  // A zero row frees x_0: every corner of the others is on a line.
  const ExactAnswer free = lcp({{0, 0}, {0, -1}}, {0, 1});
  EXPECT_TRUE(free.isolated.empty());
  EXPECT_EQ(points(free.continuum), (Points{{0, 1}, {0, -1}}));
}

TEST(OracleHlcp, FindsAnIsolatedSolutionBesideAContinuum) {
  const ExactAnswer segment = lcp({{-1, -1}, {1, 0}}, {1, 0});
  EXPECT_EQ(points(segment.isolated), (Points{{-1, 1}}));
  EXPECT_EQ(points(segment.continuum), (Points{{1, 0}, {0, -1}})) << "z1 = 0, w1 + z2 = 1";
  const ExactAnswer ray = lcp({{0, 1}, {1, 1}}, {0, -1});
  EXPECT_EQ(points(ray.isolated), (Points{{1, -1}}));
  EXPECT_EQ(points(ray.continuum), (Points{{-1, 0}})) << "z1 >= 1, w2 = z1 - 1";
}

// ---- Mechanisms, from theory: Painleve & Klein's sliders 2 u - 3 |u| = r; the overhung slider

TEST(OracleHlcp, KnowsThePainleveKleinSliders) {
  const auto sliders = [](long long r) { return solve(exactly({1, {{2 - 3}}, {{2 + 3}}, {r}})); };
  EXPECT_EQ(points(sliders(-1).isolated), (Points{{1}, {Rational(-1, 5)}}));
  EXPECT_EQ(sliders(1).count(), Count::none);
  EXPECT_EQ(points(sliders(0).isolated), (Points{{0}}));
  EXPECT_FALSE(sliders(0).w_property);
}

/// Mass 1 kg, weight 10 N, contacts at -1/20 and 1/20 m, centre of mass 3/10 m over the guide, mu 1/5, slipping to the
/// right: N1 + N2 = 10 and (N2 - N1)/20 - 3/50 (|N1| + |N2|) + moment = 0.
ExactAnswer overhung(const Rational& moment) {
  const Rational arm(1, 20), tilt(3, 50);
  const std::vector<Exact> plus = {{1, 1}, {-arm - tilt, arm - tilt}}, minus = {{1, 1}, {tilt - arm, arm + tilt}};
  return solve(exact_hlcp(2, plus, minus, Exact{10, -moment}));
}

TEST(OracleHlcp, KnowsTheOverhungSlider) {
  EXPECT_EQ(points(overhung(Rational(1, 2)).isolated), (Points{{4, 6}, {-20, 30}}));
  EXPECT_EQ(points(overhung(2).isolated), (Points{{Rational(155, 11), Rational(-45, 11)}, {-95, 105}}));
  EXPECT_EQ(overhung(Rational(99, 1000)).count(), Count::none);
  expect_one(overhung(Rational(1, 10)), {0, 10}, false);
  EXPECT_EQ(overhung(Rational(101, 1000)).count(), Count::several);
}

// ---- Numbers

TEST(OracleHlcp, TakesDoublesAsTheyAre) {
  const std::vector<std::vector<double>> one = {{1.0}};
  const Rational tenth(3602879701896397, 36028797018963968);  // the double 0.1
  EXPECT_EQ(solve(exact_hlcp(1, one, one, std::vector<double>{0.1})).isolated[0][0], tenth);
  const std::vector<std::vector<double>> plus = {{0x1p-1074, 1e308}, {0.0, 3.0}},
                                         minus = {{0x1p-1074, 0.0}, {0.0, 5.0}};
  const ExactHlcp wide = exact_hlcp(2, plus, minus, std::vector<double>{0x1p-1074, -1.0});
  EXPECT_EQ(points(solve(wide).isolated), (Points{{1, Rational(-1, 5)}}));
  EXPECT_TRUE(solve(wide).w_property);
}

TEST(OracleHlcp, ScalesRowsOfDoublesAsItScalesRowsOfRationals) {
  std::mt19937_64 random(5);
  const auto draw = [&] {
    return std::ldexp(static_cast<double>(random() % 64) - 32, static_cast<int>(random() % 160) - 80);
  };
  for (int round = 0; round < 200; ++round) {
    ExactHlcp doubles{2, {}}, rationals{2, {}};
    for (int i = 0; i < 2; ++i) {
      const std::vector<double> row = {draw(), draw(), draw(), draw(), draw()};
      append_row(doubles, row);
      append_row(rationals, exact_vector(row.data(), 5));
    }
    const ExactAnswer first = solve(doubles), second = solve(rationals);
    EXPECT_EQ(points(first.isolated), points(second.isolated));
    EXPECT_EQ(first.w_property, second.w_property);
  }
}

TEST(OracleHlcp, NumbersOfAnyLengthGiveTheSameSolutions) {
  // Entries of 8 to 30 bits, about where minors stop fitting into 127; 3^60 leaves the solutions as they are.
  std::mt19937_64 random(6);
  const Integer factor = boost::multiprecision::pow(Integer(3), 60);
  for (int round = 0; round < 3000; ++round) {
    const int n = 1 + round % 3;
    const int bits = 8 + static_cast<int>(random() % 23) + (n == 1 ? 30 : 0);
    ExactHlcp given{n, {}}, longer{n, {}};
    for (int k = 0; k < n * (2 * n + 1); ++k) {
      given.rows.emplace_back(static_cast<std::int64_t>(random()) >> (64 - bits));
      longer.rows.push_back(factor * given.rows.back());
    }
    const ExactAnswer first = solve(given), second = solve(longer);
    ASSERT_EQ(points(first.isolated), points(second.isolated)) << n << " " << bits;
    ASSERT_EQ(first.w_property, second.w_property);
  }
}

TEST(OracleHlcp, TakesMultiprecisionAsItIs) {
  using Float = boost::multiprecision::cpp_bin_float_50;
  const Float b = 1 + boost::multiprecision::ldexp(Float(1), -100);
  const std::vector<std::vector<Float>> three = {{Float(3)}};
  const Rational expected = (1 + Rational(1, boost::multiprecision::cpp_int(1) << 100)) / 3;
  EXPECT_EQ(solve(exact_hlcp(1, three, three, std::vector<Float>{b})).isolated[0][0], expected);
}

TEST(OracleHlcp, RoundsToTheNearestDouble) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 2000; ++round) {
    const double x = std::ldexp(static_cast<double>(random()) - 0x1p63, static_cast<int>(random() % 1900) - 1100);
    EXPECT_EQ(nearest_double(exact_vector(&x, 1)[0]), x);
    const double a = static_cast<double>(random() >> 12) + 1, b = static_cast<double>(random() >> 13) + 1;
    EXPECT_EQ(nearest_double(exact_vector(&a, 1)[0] / exact_vector(&b, 1)[0]), a / b);
  }
  const Rational odd = Rational((1LL << 53) + 1), tiny(1, boost::multiprecision::cpp_int(1) << 200);
  EXPECT_EQ(nearest_double(odd), 0x1p53) << "a tie, to even";
  EXPECT_EQ(nearest_double(odd + tiny), 0x1p53 + 2);
  EXPECT_EQ(nearest_double(-odd - 2), -0x1p53 - 4);
  EXPECT_EQ(nearest_double(0), 0.0);
  EXPECT_EQ(nearest_double(boost::multiprecision::cpp_int(1) << 1024), std::numeric_limits<double>::infinity());
}

TEST(OracleHlcp, MeasuresWhatACandidateMisses) {
  const ExactHlcp problem = exactly({2, {{2, 1}, {0, 0}}, {{3, 1}, {0, 0}}, {4, 0}});
  EXPECT_EQ(residual(problem, {2, 0}), 0);
  EXPECT_EQ(residual(problem, {1, 0}), Rational(2, 6)) << "|2 - 4| of |2| + |4|";
  EXPECT_EQ(residual(problem, {-1, -1}), Rational(8, 8)) << "|-3 - 1 - 4|";
  for (const std::vector<double>& x : {std::vector{2.0, 0.0}, {0.1, 0.1}, {-0.3, 0x1p-1074}, {0.1, -7e300}})
    EXPECT_EQ(residual(problem, x.data()), nearest_double(residual(problem, exact_vector(x.data(), 2)))) << x[0];
  EXPECT_EQ(distance({3, -5}, {3, -4}), Rational(1, 4));
  EXPECT_EQ(distance({3, -5}, {0, 0}), 5);
}

TEST(OracleHlcp, RefusesWhatItCannotDecide) {
  const std::vector<std::vector<double>> one = {{1.0}};
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(exact_hlcp(1, one, one, std::vector<double>{bad}), std::invalid_argument);
  const ExactHlcp large = exact_lcp(13, murty(13), Row(13, -1));
  EXPECT_THROW(solve(large), std::invalid_argument);
  EXPECT_THROW(has_w_property(large), std::invalid_argument);
  Exact x(13, 1);
  x[0] = -1;
  EXPECT_EQ(residual(large, x), 0) << "of any order";
}

}  // namespace
