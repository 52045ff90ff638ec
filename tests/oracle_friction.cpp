// Coulomb's law at an instant: every solution where friction allows several or none, what rest does, and the limits of
// the W-property. Data are multiprecision, not doubles, so that closed forms hold to all digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <slideway/oracle/hlcp.hpp>
#include <support/oracle.hpp>

namespace {

using namespace slideway::oracle;
using namespace slideway::test;
using slideway::ground;
using slideway::Joint;
using slideway::Law;

const RealVec nowhere = {Real(0), Real(0)};
/// A speed whose square is below every digit: it gives slip a direction and nothing else.
const Real creeping("1e-40");

RealModel lying_flat() {
  RealModel m{};
  m.alpha = 20;
  m.beta = 100;
  return m;
}

void add_planar(RealModel& m, const RealModel::Body& body, const std::vector<Real>& q, const std::vector<Real>& v) {
  m.body.push_back(body);
  m.start.q.insert(m.start.q.end(), q.begin(), q.end());
  m.start.v.insert(m.start.v.end(), v.begin(), v.end());
}

/// A uniform rod, m = 1 and half length 1, its end A on the x axis and B on a line at `slope`, turned by th and turning
/// at `omega`: A = (a, 0), B = b (cos slope, sin slope), B - A = 2 (cos th, sin th).
RealModel rod(const Real& slope, const Real& th, const Real& omega, const Real& mu) {
  RealModel m = lying_flat();
  const Real b = 2 * sin(th) / sin(slope), a = b * cos(slope) - 2 * cos(th);
  const Real b_rate = 2 * cos(th) * omega / sin(slope), a_rate = b_rate * cos(slope) + 2 * sin(th) * omega;
  add_planar(m, free_body(1, ratio(1, 3)), {Real(a + b * cos(slope)) / 2, Real(b * sin(slope)) / 2, th},
             {Real(a_rate + b_rate * cos(slope)) / 2, Real(b_rate * sin(slope)) / 2, omega});
  m.guide = {ground_guide(0, 0, {{-1, 0}}, mu, mu), ground_guide(0, slope, {{1, 0}}, mu, mu)};
  return m;
}

/// A block of 1 kg under 10 m/s^2, feet at +-a, centre of mass at height c, with a horizontal push at that height.
RealModel block(const Real& mu, const Real& mu_static, const Real& push, const Real& speed, const Real& c = Real(0),
                const Real& a = ratio(1, 20)) {
  RealModel m = lying_flat();
  m.gravity = {0, -10};
  add_planar(m, free_body(1, ratio(1, 100), {0, c}), {0, 0, 0}, {speed, 0, 0});
  m.guide = {ground_guide(0, 0, {{-a, 0}, {a, 0}}, mu, mu_static)};
  m.load = {{0, {0, c}, {push, 0}, 0}};
  return m;
}

/// The found sets of contact forces are these, in any order.
void expect_forces(const std::string& what, const std::vector<Solution<Real>>& found,
                   std::vector<std::vector<Real>> wanted, double digits) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  std::vector<std::vector<Real>> forces;
  for (const auto& solution : found) forces.push_back(solution.lambda);
  std::sort(forces.begin(), forces.end());
  std::sort(wanted.begin(), wanted.end());
  Agreement all;
  for (std::size_t i = 0; i < wanted.size(); ++i) all.compare_all(forces[i], wanted[i]);
  all.hold(what, digits);
}

// ---- Several answers, and none

TEST(SeveralAnswers, RodOnTwoGuides) {  // by the numbers derived for this pose
  const Real th = 105 * pi / 180;
  RealModel m = rod(pi / 6, th, creeping, ratio(3, 10));
  m.load = {{0, nowhere, {-10 * cos(th), -10 * sin(th)}, 0}};  // 10 N along the rod from B to A
  AtStart at(m);
  auto found = at.solutions({false, false});
  const Real both("4.9082864029421594688"), one("10.596908009061298911"), other("-0.59801028674709775307");
  expect_forces("three", found, {{both, both}, {one, other}, {other, one}}, 18);
  std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.lambda < y.lambda; });
  Agreement turning;
  turning.compare(found[1].acceleration[2], Real("-0.9117250795704905"));
  for (const std::size_t k : {0, 2}) turning.compare(found[k].acceleration[2], Real("-1.968399152904206"));
  turning.hold("turning", 15.5);  // printed to 16 digits
  EXPECT_EQ(at.decide().verdict, Verdict::several);
}

/// The same three by the rod's own equations: m a = sum of forces, J th'' = sum of moments, ends kept on their guides,
/// so that in each pattern of signs the forces follow from two linear equations.
TEST(SeveralAnswers, RodOnTwoGuidesByItsOwnEquations) {
  const Real th = 105 * pi / 180, mu = ratio(3, 10), slope = pi / 6;
  RealModel m = rod(slope, th, creeping, mu);
  const RealVec push{-10 * cos(th), -10 * sin(th)}, n[2] = {{0, 1}, {-sin(slope), cos(slope)}};
  m.load = {{0, nowhere, push, 0}};
  const auto dot = [](const RealVec& a, const RealVec& b) { return Real(a.x * b.x + a.y * b.y); };
  std::vector<std::vector<Real>> wanted;
  for (const int signs : {0, 1, 2, 3}) {
    Real matrix[2][2], right[2];
    for (int i = 0; i < 2; ++i) {  // end i at -+u accelerates by a -+ th'' u', u' = (-sin th, cos th)
      const Real across_i = (i == 0 ? -1 : 1) * dot(n[i], {-sin(th), cos(th)});
      right[i] = -dot(n[i], push);
      for (int j = 0; j < 2; ++j) {
        const int slip = j == 0 ? 1 : -1, sign = (signs >> j) % 2 == 0 ? 1 : -1;
        const RealVec f{n[j].x - mu * slip * sign * n[j].y, n[j].y + mu * slip * sign * n[j].x};
        matrix[i][j] = dot(n[i], f) + across_i * 3 * (j == 0 ? -1 : 1) * dot({-sin(th), cos(th)}, f);
      }
    }
    const Real det = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    const Real x = (right[0] * matrix[1][1] - matrix[0][1] * right[1]) / det;
    const Real y = (matrix[0][0] * right[1] - right[0] * matrix[1][0]) / det;
    if ((x > 0) == (signs % 2 == 0) && (y > 0) == (signs / 2 == 0)) wanted.push_back({x, y});
  }
  AtStart at(m);
  expect_forces("three", at.solutions({false, false}), wanted, 35);
}

TEST(SeveralAnswers, OverhungSlider) {
  const auto found = [](const Real& moment) {
    RealModel m = block(ratio(1, 5), ratio(1, 5), 0, 1, ratio(3, 10));
    m.load[0].torque = moment;
    AtStart at(m);
    const auto all = at.solutions({false});
    const Verdict verdict = at.decide().verdict;
    EXPECT_EQ(verdict, all.empty() ? Verdict::none : all.size() == 1 ? Verdict::unique : Verdict::several);
    return all;
  };
  expect_forces("half", found(ratio(1, 2)), {{4, 6}, {-20, 30}}, 40);
  expect_forces("two", found(2), {{ratio(155, 11), ratio(-45, 11)}, {-95, 105}}, 40);
  expect_forces("tenth", found(ratio(1, 10)), {{0, 10}}, 40);
  EXPECT_TRUE(found(ratio(1, 10) - Real("1e-25")).empty());
  EXPECT_EQ(found(ratio(1, 10) + Real("1e-25")).size(), 2u);
  EXPECT_TRUE(found(ratio(-1, 2)).empty());
}

/// Two sliders of masses m1, m2 on parallel guides 1 m apart, joined by a massless rod at 45 degrees; mu acts on the
/// first, `pull` on the second along the guides. Both move in +x.
RealModel painleve_klein(const Real& m1, const Real& m2, const Real& mu, const Real& pull) {
  RealModel m = lying_flat();
  add_planar(m, free_body(m1, 1), {0, 0, 0}, {1, 0, 0});
  add_planar(m, free_body(m2, 1), {1, 1, 0}, {1, 0, 0});
  m.body.push_back({0, Joint::revolute, nowhere, {1, 0}, 0, 0, nowhere, 0});
  m.start.q.push_back(pi / 4);
  m.start.v.push_back(0);
  m.pin = {{2, 1, {sqrt(Real(2)), 0}, nowhere}};
  m.guide = {ground_guide(0, 0, {nowhere}, mu, mu), ground_guide(1, 0, {nowhere}, 0, 0)};
  m.guide[1].origin = {0, 1};
  m.load = {{1, nowhere, {pull, 0}, 0}};
  return m;
}

TEST(SeveralAnswers, PainleveKlein) {  // 2 u - 3 |u| = r, u = -lambda of the slider with friction, tan phi = 1
  const auto found = [](const Real& pull) { return AtStart(painleve_klein(1, 1, 3, pull)).solutions({false, false}); };
  expect_forces("two", found(-1), {{-1, 1}, {ratio(1, 5), ratio(-1, 5)}}, 40);
  EXPECT_TRUE(found(1).empty());
  EXPECT_EQ(AtStart(painleve_klein(1, 1, 3, 1)).decide().verdict, Verdict::none);
  EXPECT_EQ(AtStart(painleve_klein(1, 1, ratio(19, 10), 1)).decide().verdict, Verdict::unique);
}

TEST(SeveralAnswers, RestAndSlipBothOfARodOnGuidesAtRightAngles) {
  const Real half = ratio(1, 2);
  RealModel m = rod(pi / 2, 0, 0, half);
  // The pose cos th = 24/25, sin th = 7/25: A = (2 cos th, 0), B = (0, 2 sin th)
  m.start.q = {ratio(24, 25), ratio(7, 25), pi - asin(ratio(7, 25))};
  m.load = {{0, nowhere, {6, 6}, 9}};
  AtStart at(m);
  const auto decision = at.decide();
  EXPECT_EQ(decision.verdict, Verdict::several);
  std::vector<Solution<Real>> rests, slips;
  for (const auto& s : decision.solutions) (s.at_rest[0] && s.at_rest[1] ? rests : slips).push_back(s);
  EXPECT_TRUE(decision.solutions.front().at_rest[0] && decision.solutions.front().at_rest[1]) << "rest comes first";
  expect_forces("slip", slips, {{ratio(-6669, 875), ratio(1758, 875)}}, 40);
  Agreement all;
  all.compare_all(slips[0].friction, {ratio(-6669, 1750), ratio(879, 875)});
  // v' of A along x and of B along y: the centre's acceleration +-th'' (-sin th, cos th)
  const auto& a = slips[0].acceleration;
  all.compare_all({a[0] + a[2] * ratio(7, 25), a[1] - a[2] * ratio(24, 25)}, {ratio(9, 25), ratio(-216, 175)});
  ASSERT_EQ(rests.size(), 2u) << "the ends of the line of admissible forces";
  for (const auto& s : rests) {  // equilibrium: forces, and moments about the centre
    const Real &na = s.lambda[0], &nb = s.lambda[1], &fa = s.friction[0], &fb = s.friction[1];
    all.compare_all({fa - nb, na + fb}, {-6, -6});
    all.compare(ratio(24, 25) * (na - fb) + ratio(7, 25) * (fa + nb), Real(-9));
    EXPECT_LE(abs(fa), half * abs(na) + Real("1e-40"));
    EXPECT_LE(abs(fb), half * abs(nb) + Real("1e-40"));
  }
  // The published one is between them.
  const Real published[] = {Real("-8.25625"), Real("4.95"), Real("-1.05"), Real("2.25625")};
  const Real share = (published[0] - rests[0].lambda[0]) / (rests[1].lambda[0] - rests[0].lambda[0]);
  EXPECT_TRUE(share > 0 && share < 1) << share;
  const auto between = [&](const Real& x, const Real& y) { return Real(x + share * (y - x)); };
  all.compare(between(rests[0].lambda[1], rests[1].lambda[1]), published[1]);
  all.compare(between(rests[0].friction[0], rests[1].friction[0]), published[2]);
  all.compare(between(rests[0].friction[1], rests[1].friction[1]), published[3]);
  all.hold("rest_and_slip", 40);
}

// ---- Rest

TEST(Rest, HoldsAgainstAPushBetweenTheKineticAndTheStaticLimit) {  // mu Lambda = 1 N, mu0 Lambda = 1.5 N
  Agreement all;
  for (const Real& push : {ratio(-5, 4), ratio(1, 2), ratio(5, 4), ratio(3, 2)}) {
    const auto decision = AtStart(block(ratio(1, 10), ratio(3, 20), push, 0)).decide();
    EXPECT_EQ(decision.verdict, Verdict::unique) << push;
    const auto& s = decision.solutions.front();
    EXPECT_TRUE(s.at_rest[0]) << push;
    all.compare(s.acceleration[0], 0, 1);
    all.compare(s.friction[0], -push);
  }
  all.hold("rest", 40);
}

TEST(Rest, BreaksAwayAtTheStaticLimitAndSlipsWithTheKineticCoefficient) {
  Agreement all;
  for (const Real& push : {Real(2), Real(-2), ratio(3, 2) + Real("1e-25")}) {
    const auto decision = AtStart(block(ratio(1, 10), ratio(3, 20), push, 0)).decide();
    EXPECT_EQ(decision.verdict, Verdict::unique) << push;
    const int direction = push > 0 ? 1 : -1;
    EXPECT_EQ(decision.solutions.front().mode.slip[0], direction);
    EXPECT_EQ(decision.mu[0], ratio(1, 10));
    all.compare(decision.solutions.front().acceleration[0], Real(push - direction));
    all.compare(decision.solutions.front().friction[0], Real(-direction));
  }
  all.hold("slip", 40);
}

/// The block on a spring to a body driven by `law` from 0; 1 N/m, free length 1, so the pull is law(t) + offset.
RealModel pulled_block(const Real& pull, const Real& rate, const Real& second) {
  RealModel m = block(ratio(1, 10), ratio(3, 20), 0, 0);
  m.body.push_back({ground, Joint::prismatic, {2, 0}, {1, 0}, 0, 1, nowhere, 1});
  m.start.q.push_back(pull);
  m.start.v.push_back(rate);
  m.drive = {{1, 0, Law::polynomial, {pull, rate, second}}};
  m.spring = {{0, 1, nowhere, nowhere, 1, 2, 0}};
  return m;
}

TEST(Rest, AtTheStaticLimitTheNextInstantDecides) {
  const Real limit = ratio(3, 2);
  const auto slip = [&](const Real& pull, const Real& rate, const Real& second) {
    const auto decision = AtStart(pulled_block(pull, rate, second)).decide();
    EXPECT_EQ(decision.verdict, Verdict::unique);
    const auto& s = decision.solutions.front();
    const Real net = s.mode.slip[0] == 0 || s.at_rest[0] ? Real(0) : Real(pull - s.mode.slip[0]);
    EXPECT_LT(abs(Real(s.acceleration[0] - net)), Real("1e-40"));
    return s.at_rest[0] ? 0 : s.mode.slip[0];
  };
  EXPECT_EQ(slip(limit, 1, 0), 1);
  EXPECT_EQ(slip(limit, -1, 0), 0);
  EXPECT_EQ(slip(limit, 0, 1), 1);
  EXPECT_EQ(slip(limit, 0, -1), 0);
  EXPECT_EQ(slip(limit, 0, 0), 0);
  EXPECT_EQ(slip(-limit, -1, 0), -1);
  EXPECT_EQ(slip(-limit, 1, 0), 0);
}

/// A trammel in the pose of 45 degrees under a weight of 10 N: with N the force on A, friction there is 5 - N, and B
/// has 5 - N and friction 10 - N.
Decision<Real> trammel_at_rest(const Real& mu) {
  RealModel m = rod(pi / 2, 3 * pi / 4, 0, mu);
  m.gravity = {0, -10};
  const auto decision = AtStart(m).decide();
  Agreement all;
  for (const auto& s : decision.solutions) {
    EXPECT_TRUE(s.at_rest[0] && s.at_rest[1]);
    for (const Real& a : s.acceleration) all.compare(a, 0, 1);
    all.compare_all({s.friction[0], s.lambda[1], s.friction[1]}, {5 - s.lambda[0], 5 - s.lambda[0], 10 - s.lambda[0]});
    for (std::size_t g = 0; g < 2; ++g) EXPECT_LE(abs(s.friction[g]), mu * abs(s.lambda[g]) + Real("1e-40"));
  }
  all.hold("equilibrium_mu_" + mu.str(2), 40);
  return decision;
}

TEST(Rest, OfATrammelIsOneMotionWithManyForces) {       // two guides, one degree of freedom
  const auto decision = trammel_at_rest(ratio(9, 10));  // 145/19 <= N <= 50
  EXPECT_EQ(decision.verdict, Verdict::motion_only);
  expect_forces("ends", decision.solutions, {{ratio(145, 19), ratio(-50, 19)}, {50, -45}}, 40);
}

TEST(Rest, OfATrammelThatJamsIsOneMotionWithManyForces) {                 // mu >= 1: no force is too large
  EXPECT_EQ(trammel_at_rest(1).verdict, Verdict::motion_only);            // N >= 7.5
  EXPECT_EQ(trammel_at_rest(ratio(3, 2)).verdict, Verdict::motion_only);  // N <= -10 or N >= 7
}

/// Collars with two contacts each, 2 feet of 1/20 m apart from their pins, on guides at right angles, joined by a rod
/// at 45 degrees; torques of 1 N m keep both feet of each loaded with 10 N at least: with mu = 2 rest holds whatever
/// the force in the rod, which nothing determines.
TEST(Rest, OfCollarsThatJamWhateverTheForceBetweenThem) {
  RealModel m = lying_flat();
  const Real foot = ratio(1, 20), side = sqrt(Real(2));
  add_planar(m, free_body(1, 1), {side, 0, 0}, {0, 0, 0});
  add_planar(m, free_body(1, 1), {0, side, 0}, {0, 0, 0});
  m.body.push_back({0, Joint::revolute, nowhere, {1, 0}, 0, 1, nowhere, 1});
  m.start.q.push_back(3 * pi / 4);
  m.start.v.push_back(0);
  m.pin = {{2, 1, {2, 0}, nowhere}};
  m.guide = {ground_guide(0, 0, {{-foot, 0}, {foot, 0}}, 2, 2), ground_guide(1, pi / 2, {{0, -foot}, {0, foot}}, 2, 2)};
  m.load = {{0, nowhere, {1, 0}, 1}, {1, nowhere, {0, ratio(1, 2)}, 1}};
  const auto decision = AtStart(m).decide();
  EXPECT_EQ(decision.verdict, Verdict::motion_only);
  for (const auto& s : decision.solutions) EXPECT_TRUE(s.at_rest[0] && s.at_rest[1]);
}

TEST(Rest, OfADrivenGuideThatDwellsIsOneMotionWithManyForces) {
  RealModel m = block(ratio(1, 10), ratio(1, 10), 0, 0);
  m.drive = {{0, 0, Law::polynomial, {0}}};
  const auto decision = AtStart(m).decide();
  EXPECT_EQ(decision.verdict, Verdict::motion_only);
  ASSERT_FALSE(decision.solutions.empty());
  for (const auto& s : decision.solutions) {
    EXPECT_TRUE(s.at_rest[0]);
    EXPECT_LE(abs(s.friction[0]), 1 + Real("1e-40"));
  }
}

TEST(Rest, IsNotForAGuideWhoseMotionFrictionCannotChange) {  // the driven crank-rocker at a reversal of its slot
  for (const int quarter : {1, 3}) {
    RealModel m = shipped("crank_rocker");
    const Real crank = quarter * pi / 2, r = ratio(1, 2) + (quarter == 1 ? 1 : 0);
    m.drive[0].c = {crank, Real(3)};
    m.start.q = {pi / 2, crank};
    m.start.v = {quarter == 1 ? Real(1) : Real(-3), 3};
    AtStart at(m);
    ASSERT_TRUE(at.dynamics.project(at.motion, {true}));
    ASSERT_TRUE(at.law.find_at_rest(at.motion, Real(1e-12))[0]);
    const auto decision = at.decide();
    EXPECT_EQ(decision.verdict, Verdict::unique);
    EXPECT_FALSE(decision.solutions.front().at_rest[0]);
    EXPECT_EQ(decision.solutions.front().mode.slip[0], quarter == 1 ? -1 : 1);
    Agreement all;  // r'^2 + r r'' = d/dt (3/2 cos 3 t), r' = 0
    at.law.solutions(at.motion, {true}, {ratio(1, 5)});
    ASSERT_TRUE(at.dynamics.solve(decision.solutions.front().mode, {ratio(1, 5)}));
    at.dynamics.extend();
    all.compare(at.dynamics.sliding(0).speed[1], Real((quarter == 1 ? -1 : 1) * ratio(9, 2) / r));
    all.hold("slip_acceleration_" + std::to_string(quarter), 40);
  }
}

// ---- Limits of the W-property

/// A+ x+ - A- x- = b of a model's contact forces at its start, in the slips of its speeds, exactly.
ExactHlcp contact_problem(const RealModel& model) {
  AtStart at(model);
  Mode mode{{}, std::vector<int>(static_cast<std::size_t>(at.dynamics.contacts()), 1)};
  mode.sign.back() = -1;  // any signs give the same problem
  Coefficients<Real> mu;
  for (int g = 0; g < at.dynamics.guides(); ++g) {
    mu.push_back(at.dynamics.guide(g).mu);
    mode.slip.push_back(!(mu.back() > 0) ? 0 : at.dynamics.sliding(g).speed[0] > 0 ? 1 : -1);
  }
  Dynamics<Real>::ContactProblem p;
  if (!at.dynamics.contact_problem(mode, mu, p)) throw std::runtime_error("singular without contacts");
  const auto rows = [&](const std::vector<Real>& flat) {
    std::vector<std::vector<Real>> matrix;
    for (int i = 0; i < p.n; ++i) matrix.emplace_back(flat.begin() + i * p.n, flat.begin() + (i + 1) * p.n);
    return matrix;
  };
  return exact_hlcp(p.n, rows(p.plus), rows(p.minus), p.b);
}

bool is_w(const RealModel& model) { return has_w_property(contact_problem(model)); }

TEST(ContactProblem, HasTheSolutionsThatModesHave) {
  const auto expect_same = [](const char* what, const RealModel& m) {
    std::vector<std::vector<Real>> exact;
    for (const Exact& x : solve(contact_problem(m)).isolated) exact.emplace_back(x.begin(), x.end());
    AtStart at(m);
    const std::vector<bool> moving(m.guide.size(), false);
    expect_forces(what, at.solutions(moving), exact, 40);
    EXPECT_GE(exact.size(), 2u);
  };
  RealModel three = rod(pi / 6, 105 * pi / 180, ratio(1, 10), ratio(3, 10));
  three.load = {{0, nowhere, {ratio(26, 10), ratio(-97, 10)}, 0}};
  expect_same("rod", three);
  RealModel two = block(ratio(1, 5), ratio(1, 5), 1, 1, ratio(3, 10));
  two.load[0].torque = 1;
  expect_same("block", two);
  expect_same("sliders", painleve_klein(1, 2, 3, -1));
}

/// Where a one-parameter family of models loses the property, by bisection to 1e-14 of the interval.
Real limit(Real good, Real bad, const std::function<RealModel(const Real&)>& family) {
  EXPECT_TRUE(is_w(family(good)));
  EXPECT_FALSE(is_w(family(bad)));
  for (int step = 0; step < 47; ++step) {
    const Real middle = (good + bad) / 2;
    (is_w(family(middle)) ? good : bad) = middle;
  }
  return (good + bad) / 2;
}

void expect_limit(const char* what, const Real& found, const Real& wanted) {
  Agreement all;
  all.compare(found, wanted);
  all.hold(what, 12);
}

/// The driven slider-crank with the slider as a point, rod of length 1.
RealModel slider_crank(const Real& crank_length, const Real& angle) {
  RealModel m = shipped("slider_crank_driven");
  const Real rod = -asin(Real(crank_length * sin(angle)));
  const Real speed = -10 * crank_length * cos(angle) / cos(rod);
  m.body[1].at = {crank_length, 0};
  m.body[2].at = {1, 0};
  m.guide[0].contact = {nowhere};
  m.guide[0].mu = m.guide[0].mu_static = ratio(1, 5);
  m.start.q = {angle, rod - angle, -rod};
  m.start.v = {10, speed - 10, -speed};
  m.drive[0].c = {angle, Real(10)};
  return m;
}

TEST(WProperty, EndsForADrivenSliderCrankWhereTheRodIsTooSteep) {  // mu |tan| = 1
  const Real by_length = limit(ratio(9, 10), ratio(99, 100), [](const Real& r) { return slider_crank(r, pi / 2); });
  expect_limit("ratio", by_length, 1 / sqrt(ratio(104, 100)));
  EXPECT_LT(abs(Real(by_length - Real("0.98058067569092016"))), Real("1e-12"));
  const Real by_angle = limit(pi / 4, ratio(15, 10), [](const Real& angle) { return slider_crank(1, angle); });
  expect_limit("angle", by_angle, atan(Real(5)));
  EXPECT_LT(abs(Real(by_angle * 180 / pi - Real("78.690"))), Real("1e-3"));
}

TEST(WProperty, EndsForAnOverhungSliderWhereMuTimesHeightIsTheFoot) {
  expect_limit("mu", limit(0, 1, [](const Real& mu) { return block(mu, mu, 0, 1, ratio(3, 10)); }), ratio(1, 6));
}

TEST(WProperty, EndsForARodOnTwoGuidesAtTheTangentOfHalfTheirAngle) {
  const Real found = limit(0, 1, [](const Real& mu) { return rod(pi / 6, 105 * pi / 180, creeping, mu); });
  expect_limit("mu", found, tan(Real(pi / 12)));
  EXPECT_LT(abs(Real(found - Real("0.267949192431"))), Real("1e-12"));
}

TEST(WProperty, EndsForATrammelAtOne) {
  const auto trammel = [](const Real& mu_a, const Real& mu_b, const Real& th) {
    RealModel m = rod(pi / 2, pi - th, 1, mu_a);
    m.guide[1].mu = m.guide[1].mu_static = mu_b;
    return m;
  };
  expect_limit("mu", limit(0, 2, [&](const Real& mu) { return trammel(mu, mu, pi / 4); }), 1);
  EXPECT_FALSE(is_w(trammel(2, ratio(1, 4), pi / 4)));
  EXPECT_TRUE(is_w(trammel(ratio(11, 10), ratio(11, 10), pi / 36)));
  for (int degrees = 5; degrees < 360; degrees += 10) {
    EXPECT_TRUE(is_w(trammel(ratio(99, 100), ratio(99, 100), degrees * pi / 180))) << degrees;
  }
}

/// A rod of inertia k m l^2, l = 1, its point on the guide, at an angle th.
RealModel painleve_rod(const Real& k, const Real& th, const Real& mu) {
  RealModel m = lying_flat();
  add_planar(m, free_body(1, k), {cos(th), sin(th), th}, {-1, 0, 0});
  m.guide = {ground_guide(0, 0, {{-1, 0}}, mu, mu)};
  return m;
}

TEST(WProperty, EndsForPainlevesRodAtTwiceTheRoot) {  // 2 sqrt(k (k + 1)), at tan^2 = (k + 1) / k
  struct {
    Real k, wanted;
    const char* name;
  } const cases[] = {{ratio(1, 3), ratio(4, 3), "third"}, {ratio(1, 100), 2 * sqrt(Real("0.0101")), "hundredth"}};
  for (const auto& c : cases) {
    const Real th = atan(Real(sqrt(Real((c.k + 1) / c.k))));
    const auto at = [&](const Real& angle) {
      return limit(0, 4, [&](const Real& mu) { return painleve_rod(c.k, angle, mu); });
    };
    const Real found = at(th), off = ratio(1, 100);
    expect_limit(c.name, found, c.wanted);
    EXPECT_GT(at(th - off), found);
    EXPECT_GT(at(th + off), found);
  }
  EXPECT_LT(abs(Real(2 * sqrt(Real("0.0101")) - Real("0.200997512"))), Real("1e-9"));
}

TEST(WProperty, EndsForPainleveAndKleinAtOnePlusTheMassRatio) {
  const auto found = [](const Real& m1, const Real& m2) {
    return limit(0, 4, [&](const Real& mu) { return painleve_klein(m1, m2, mu, 0); });
  };
  expect_limit("equal", found(1, 1), 2);
  expect_limit("half", found(1, 2), ratio(3, 2));
}

}  // namespace
