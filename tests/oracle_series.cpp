// The oracle's two tools against closed forms: Taylor series on a tape, and the first root of a polynomial.
#include <gtest/gtest.h>

#include <optional>
#include <slideway/oracle/roots.hpp>
#include <slideway/oracle/series.hpp>
#include <support/oracle.hpp>

namespace {

using namespace slideway::oracle;
using slideway::test::Agreement;
using slideway::test::ratio;
using Series = std::vector<Real>;

constexpr int orders = 24;

/// As a trajectory does it: positions are known one order ahead.
void extend(Tape<Real>& tape, const Tape<Real>::Node& x, const Series& coefficients) {
  const auto coefficient = [&](int k) {
    const auto at = static_cast<std::size_t>(k);
    return at < coefficients.size() ? coefficients[at] : Real(0);
  };
  tape.set(x, 0, coefficient(0));
  for (int k = 0; k < orders; ++k) {
    if (k + 1 < orders) tape.set(x, k + 1, coefficient(k + 1));
    tape.extend(k);
  }
}

/// Coefficients of a node against known ones, each relative to itself.
Agreement agreement(const Tape<Real>::Node& node, const Series& known, int last = orders) {
  Agreement all;
  for (int k = 0; k < last; ++k) {
    const Real& expected = known[static_cast<std::size_t>(k)];
    all.compare(node[k], expected, expected == 0 ? Real(1) : Real(abs(expected)));
  }
  return all;
}

/// Of f(a + b t), `derivative(k)` being f's k-th at a.
template <class Derivative>
Series linear_argument(const Real& b, const Derivative& derivative) {
  Series s;
  Real power(1);  // b^k / k!
  for (int k = 0; k < orders; ++k, power *= b / k) s.push_back(derivative(k) * power);
  return s;
}

const Real a = ratio(7, 10), b = ratio(13, 10);  // the argument of what follows: a + b t

TEST(Series, SineAndCosineOfAUniformTurn) {
  Tape<Real> tape(orders);
  const auto x = tape.variable();
  const auto turn = tape.turn(x);
  extend(tape, x, {a, b});
  const auto sine = [](int k) { return k % 4 == 0 ? sin(a) : k % 4 == 1 ? cos(a) : k % 4 == 2 ? -sin(a) : -cos(a); };
  agreement(turn.sine, linear_argument(b, sine)).hold("sine", 45);
  agreement(turn.cosine, linear_argument(b, [&](int k) { return sine(k + 1); })).hold("cosine", 45);
}

TEST(Series, SineOfASquare) {  // t^2 - t^6 / 3! + ..., an argument that is not linear
  Tape<Real> tape(orders);
  const auto x = tape.variable();
  const auto turn = tape.turn(x);
  extend(tape, x, {0, 0, 1});
  Series sine(orders, Real(0)), cosine(orders, Real(0));
  Real factorial(1);
  for (int k = 0; 2 * k < orders; ++k, factorial *= k) {
    (k % 2 == 0 ? cosine : sine)[static_cast<std::size_t>(2 * k)] = (k % 4 < 2 ? 1 : -1) / factorial;
  }
  agreement(turn.sine, sine).hold("sine", 45);
  agreement(turn.cosine, cosine).hold("cosine", 45);
}

TEST(Series, ReciprocalAndRoot) {
  Tape<Real> tape(orders);
  const auto x = tape.variable(), inverse = reciprocal(x), square_root = root(x);
  extend(tape, x, {a, b});
  Series inverses, roots;
  Real of_inverse = 1 / a, of_root = sqrt(a);  // (-1)^k b^k / a^(k+1); binomial(1/2, k) sqrt(a) (b/a)^k
  for (int k = 0; k < orders; ++k) {
    inverses.push_back(of_inverse);
    roots.push_back(of_root);
    of_inverse *= -b / a;
    of_root *= (ratio(1, 2) - k) / (k + 1) * (b / a);
  }
  agreement(inverse, inverses).hold("reciprocal", 45);
  agreement(square_root, roots).hold("root", 45);
}

TEST(Series, SumsProductsAndConstants) {
  Tape<Real> tape(orders);
  using Node = Tape<Real>::Node;
  const auto x = tape.variable();
  const auto turn = tape.turn(x);
  const Node half(ratio(1, 2));
  // sin cos = sin(2 x) / 2; the other terms and factors cancel.
  const auto product = turn.sine * turn.cosine;
  const auto roundabout = (Node(Real(3)) * product - product) * half + (Node(Real(5)) - Node(Real(5))) - Node() * x;
  const auto shifted = (half + x) - half;
  extend(tape, x, {a, b});
  const auto sine = [](int k) {
    const Real s = sin(Real(2 * a)), c = cos(Real(2 * a));
    return (k % 4 == 0 ? s : k % 4 == 1 ? c : k % 4 == 2 ? Real(-s) : Real(-c)) / 2;
  };
  agreement(product, linear_argument(2 * b, sine)).hold("product", 45);
  agreement(roundabout, linear_argument(2 * b, sine)).hold("roundabout", 45);
  Series line(orders, Real(0));
  line[0] = a;
  line[1] = b;
  agreement(shifted, line).hold("shifted", 45);
  EXPECT_EQ(half[0], ratio(1, 2));
  EXPECT_EQ(half[1], 0);
}

TEST(Series, RateOfWhatDependsOnPositions) {  // d/dt sin(a + b t) = b cos(a + b t); times a speed, b
  Tape<Real> tape(orders);
  const auto x = tape.variable();
  const auto turn = tape.turn(x);
  const auto speed = rate(turn.sine), power = speed * rate(x), sum = power + turn.sine;
  extend(tape, x, {a, b});
  const auto cosine = [](int k) { return k % 4 == 0 ? cos(a) : k % 4 == 1 ? -sin(a) : k % 4 == 2 ? -cos(a) : sin(a); };
  const Series known = linear_argument(b, [&](int k) { return b * cosine(k); });
  const Series twice = linear_argument(b, [&](int k) { return b * b * cosine(k); });
  const Series both = linear_argument(b, [&](int k) { return b * b * cosine(k) + cosine(k + 3); });
  agreement(speed, known, orders - 1).hold("rate", 45);  // the last rate would need one order more
  agreement(power, twice, orders - 1).hold("power", 45);
  agreement(sum, both, orders - 1).hold("sum", 45);
}

TEST(Series, IdentitiesOfARandomSeries) {  // r r = x, x / x = 1, sin^2 + cos^2 = 1, coefficients of size 1
  Tape<Real> tape(orders);
  const auto x = tape.variable(), r = root(x), square = r * r, one = x * reciprocal(x);
  const auto turn = tape.turn(x);
  const auto circle = turn.sine * turn.sine + turn.cosine * turn.cosine;
  Series series = {Real(2)}, unit(orders, Real(0));
  for (int k = 1; k < orders; ++k) series.push_back(cos(Real(k * k)));
  unit[0] = 1;
  extend(tape, x, series);
  agreement(square, series).hold("square", 40);  // sums of 24 products up to 1e5 times their result
  agreement(one, unit).hold("quotient", 40);
  agreement(circle, unit).hold("circle", 40);
}

// ---- First root

Series from_roots(const Series& roots, const Real& factor) {
  Series p = {factor};
  for (const Real& root : roots) {
    p.push_back(Real(0));
    for (std::size_t k = p.size() - 1; k > 0; --k) p[k] = p[k - 1] - root * p[k];
    p[0] *= -root;
  }
  return p;
}

void expect_root(const char* what, const Series& p, const Real& root, double digits) {
  const auto found = first_root(p);
  ASSERT_TRUE(found) << what;
  Agreement all;
  all.compare(*found, root);
  all.hold(what, digits);
}

TEST(FirstRoot, OfSeveralIsTheLeast) {
  expect_root("line", from_roots({ratio(1, 3)}, -1), ratio(1, 3), 45);
  expect_root("cubic", from_roots({ratio(9, 10), ratio(1, 7), ratio(3, 5)}, -1), ratio(1, 7), 45);
  expect_root("outside", from_roots({ratio(-1, 2), ratio(2, 3), 3, -4}, 1), ratio(2, 3), 45);
  Series many;
  for (int k = 1; k <= 12; ++k) many.push_back(ratio(k, 13));
  expect_root("twelve", from_roots(many, 1), ratio(1, 13), 40);  // condition of the first root: 1e4
}

TEST(FirstRoot, AtAPlaceThatBisectionMeets) {  // the interval is halved exactly at the root
  expect_root("half", from_roots({ratio(1, 2), ratio(3, 4)}, 1), ratio(1, 2), 45);
  expect_root("quarter", from_roots({ratio(1, 4), ratio(3, 8), ratio(7, 8)}, -1), ratio(1, 4), 45);
  expect_root("lone", {ratio(1, 2), ratio(-9, 4), ratio(9, 2), -4}, ratio(1, 2), 45);  // (1/2 - x)(1 - 5/2 x + 4 x^2)
}

TEST(FirstRoot, OfAClusterIsTheLeast) {  // 1e-6 apart: condition 1e6 for a pair, 1e12 for three
  const Real gap("1e-6"), at = ratio(2, 7);
  expect_root("pair", from_roots({at + gap, at}, 1), at, 40);
  expect_root("three", from_roots({at + gap, at, at + 2 * gap}, -1), at, 35);
}

TEST(FirstRoot, AtTheEndCounts) {
  expect_root("line", {1, -1}, 1, 45);
  expect_root("cubic", from_roots({Real(1), ratio(4, 3), ratio(-1, 2)}, 1), 1, 45);
}

TEST(FirstRoot, AtTheStartIsWhereTheCallerComesFrom) {
  expect_root("deflated", from_roots({Real(0), ratio(2, 5)}, -1), ratio(2, 5), 45);
  expect_root("rounding", {Real("1e-45"), 1, ratio(-5, 2)}, ratio(2, 5), 40);
  EXPECT_FALSE(first_root(Series{0, 0, 1}));
  EXPECT_FALSE(first_root(Series{Real("-1e-45"), 1, 1}));
}

TEST(FirstRoot, IsZeroWhereThePolynomialFallsBelowAtOnce) {
  for (const Series& p : {Series{-1, 3}, Series{0, -1, 5}, Series{0, 0, -1, 5}, Series{Real("1e-45"), -1, 5}}) {
    const auto root = first_root(p);
    ASSERT_TRUE(root);
    EXPECT_EQ(*root, 0);
  }
}

TEST(FirstRoot, IsNoneWhereThereIsNone) {
  EXPECT_FALSE(first_root(Series{}));
  EXPECT_FALSE(first_root(Series{0, 0, 0}));
  EXPECT_FALSE(first_root(Series{1}));
  EXPECT_FALSE(first_root(from_roots({ratio(3, 2), ratio(-1, 2)}, -1)));
  EXPECT_FALSE(first_root(Series{1, -3, ratio(5, 2)}));  // its vertex, 1/10 above zero
}

TEST(FirstRoot, OfAGrazeCountsOnlyIfItDips) {
  const Real at = ratio(3, 7);
  Series p = from_roots({at, at}, 1);
  EXPECT_FALSE(first_root(p)) << "touches zero";
  const Series twice = from_roots({at, at, ratio(5, 6)}, -1);
  expect_root("after_graze", twice, ratio(5, 6), 40);
  const Real depth("1e-20");
  p[0] -= depth;
  expect_root("dip", p, at - sqrt(depth), 35);  // condition 1e10
  p[0] += 2 * depth;
  EXPECT_FALSE(first_root(p)) << "stays above";
}

}  // namespace
