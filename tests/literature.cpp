// Numbers from elsewhere: published solutions, and cases whose answers, or lack of one, are known in closed form
// (docs/theory.md, where methods fail).
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/io/stepper.hpp>
#include <string>
#include <vector>

namespace {

using slideway::Joint;
using slideway::NotUnique;
using slideway::Report;
using slideway::Status;
using slideway::Uniqueness;
using slideway::Vec2;
using slideway::io::RunSize;
using Scene = slideway::Scene<RunSize>;
using Stepper = slideway::RunTimeStepper<RunSize>;
using State = Stepper::State;
using Reaction = Stepper::Reaction;

Scene shipped(const std::string& name, const std::vector<std::string>& settings = {}) {
  const auto reading = slideway::io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml", settings);
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene ? reading.scene->scene : Scene{};
}

/// |computed - given| over |given|.
double miss(double computed, double given) { return std::fabs(computed - given) / std::fabs(given); }

struct Answer {
  Report report;
  Reaction reaction;
};

/// The reaction at the scene's start, with these contact signs to begin with.
Answer answer(const Stepper& stepper, const std::vector<int>& signs = {}) {
  Answer answer;
  State state = stepper.start();
  for (std::size_t c = 0; c < signs.size(); ++c) state.sign[c] = static_cast<signed char>(signs[c]);
  answer.report = stepper.reaction(state, {}, answer.reaction);
  return answer;
}

Answer answer_along(const Scene& scene, const std::vector<int>& signs) {
  Stepper stepper(scene);
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  return answer(stepper, signs);
}

/// Is there one answer to this, whatever the loads? The W-property of the start's problem.
bool certified(const Scene& scene) {
  const Report report = answer(Stepper(scene)).report;
  return report.status == Status::ok && report.uniqueness == Uniqueness::certified;
}

// --- Andrews' squeezing mechanism ------------------------------------------------------------------------------------
// Bari test set of initial value problems (Mazzia and Magherini 2008), problem andrews: start values of 29 digits, and
// a solution at 0.03 s, computed there by PSIDE with tolerance 1e-14, in the test set's order: beta, Theta, gamma, Phi,
// delta, Omega, eps. Coordinates of the scene in that order:
constexpr int coordinate[7] = {0, 1, 2, 4, 3, 6, 5};

TEST(Squeezer, StartsWithThePublishedAccelerationsAndForces) {
  const Answer start = answer(Stepper(shipped("squeezer")));
  ASSERT_EQ(start.report.status, Status::ok);
  const double* a = start.reaction.acceleration;
  // Relative. Measured: 4e-15; the start's doubles and the data's are 1e-16 off, and the loops magnify that.
  EXPECT_LT(miss(a[0], 14222.4439199541138705911625887), 1e-12);
  EXPECT_LT(miss(a[1], -10666.8329399655854029433719415), 1e-12);
  for (int k = 2; k < 7; ++k) EXPECT_LT(std::fabs(a[coordinate[k]]), 1e-8);  // rad/s^2, beside 1e4; published: 0
  // The test set's multipliers are forces of K3, K4 and K6 on K2, reversed.
  EXPECT_LT(miss(start.reaction.pin[0].x, -98.5668703962410896057654982170), 1e-12);
  EXPECT_LT(miss(start.reaction.pin[0].y, 6.12268834425566265503114393122), 1e-12);
  for (int p = 1; p < 3; ++p) {
    EXPECT_LT(std::hypot(start.reaction.pin[p].x, start.reaction.pin[p].y), 1e-10);  // N, beside 1e2; published: 0
  }
}

TEST(Squeezer, IsWhereThePublishedSolutionIs) {
  const double q[7] = {0.1581077119629904e2, -0.1575637105984298e2, 0.4082224013073101e-1, -0.5347301163226948,
                       0.5244099658805304,   0.5347301163226948,    0.1048080741042263e1};
  const double v[7] = {0.1139920302151208e4, -0.1424379294994111e4, 0.1103291221937134e2, 0.1929337464421385e2,
                       0.5735699284790808,   -0.1929337464421385e2, 0.3231791658026955};
  const double a[7] = {-0.2463176316945196e5, 0.5185037701610329e5,  0.3241025686413781e6, 0.5667493645176213e6,
                       0.1674362929479361e5,  -0.5667493645176222e6, 0.9826520791458422e4};
  const double force[6] = {0.1991753333731910e3, -0.2975531228015052e2, 0.2306654119098399e2,
                           0.3145271365475927e2, 0.2264249232082739e2,  0.1161740700019673e2};
  const Stepper stepper(shipped("squeezer"));
  State state = stepper.start();
  while (state.steps < 12000) ASSERT_EQ(stepper.step(state, 2.5e-6).status, Status::ok);
  Reaction reaction;
  ASSERT_EQ(stepper.reaction(state, {}, reaction).status, Status::ok);
  double worst[4] = {};
  for (int k = 0; k < 7; ++k) {
    const int j = coordinate[k];
    worst[0] = std::fmax(worst[0], std::fabs(state.q[j] - q[k]) / std::fmax(1, std::fabs(q[k])));
    worst[1] = std::fmax(worst[1], miss(state.v[j], v[k]));
    worst[2] = std::fmax(worst[2], miss(reaction.acceleration[j], a[k]));
  }
  for (int p = 0; p < 3; ++p) {
    worst[3] = std::fmax(worst[3], miss(reaction.pin[p].x, -force[2 * p]));
    worst[3] = std::fmax(worst[3], miss(reaction.pin[p].y, -force[2 * p + 1]));
  }
  // The published values are good to about this much, and no more (docs/theory.md); dt makes an error well below.
  EXPECT_LT(worst[0], 1e-9);  // rad, beyond one radian relative
  EXPECT_LT(worst[1], 1e-7);  // relative
  EXPECT_LT(worst[2], 2e-6);
  EXPECT_LT(worst[3], 2e-6);
  RecordProperty("q", testing::PrintToString(worst[0]));
  RecordProperty("v", testing::PrintToString(worst[1]));
  RecordProperty("a", testing::PrintToString(worst[2]));
  RecordProperty("force", testing::PrintToString(worst[3]));
}

// --- overhung slider -------------------------------------------------------------------------------------------------
// Feet at -a and +a, centre of mass c over them, weight W, slipping on, moment Me: with D = lambda2 - lambda1,
//   lambda1 + lambda2 = W,  a D = mu c Lambda - Me.
// Both feet press: D = (mu c W - Me) / a. The first pulls, Lambda = D: D = Me / (mu c - a). The second pulls,
// Lambda = -D: D = -Me / (mu c + a). Unique for every load iff mu c < a.

Scene overhung(double mu, double moment) {
  Scene scene = shipped("overhung_slider");
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  scene.load[0].torque = moment;
  return scene;
}

void expect_feet(const Answer& answer, Uniqueness uniqueness, double first, double second) {
  ASSERT_EQ(answer.report.status, Status::ok);
  EXPECT_EQ(answer.report.uniqueness, uniqueness);
  // Relative to the larger force; rounding of data (0.3 - 0.05 / 0.2 carries 20 times theirs) and of the solution.
  const double size = std::fmax(std::fabs(first), std::fabs(second));
  EXPECT_NEAR(answer.reaction.lambda[0], first, 1e-12 * size);
  EXPECT_NEAR(answer.reaction.lambda[1], second, 1e-12 * size);
}

TEST(OverhungSlider, HasOneAnswerBelowItsLimit) {
  expect_feet(answer(Stepper(overhung(0.1, 0.5))), Uniqueness::certified, 7, 3);
  expect_feet(answer(Stepper(overhung(0.1, 0))), Uniqueness::certified, 2, 8);
  EXPECT_TRUE(certified(overhung(0.16666, 0.5)));  // limit 1/6
  EXPECT_FALSE(certified(overhung(0.16667, 0.5)));
}

TEST(OverhungSlider, HasNoneOrTwoBeyond) {
  for (const double moment : {-1.0, 0.0, 0.0999}) {
    EXPECT_EQ(answer(Stepper(overhung(0.2, moment))).report.status, Status::no_solution) << moment;
    EXPECT_EQ(answer_along(overhung(0.2, moment), {1, 1}).report.status, Status::no_solution) << moment;
  }
  EXPECT_EQ(answer(Stepper(overhung(0.2, 0.5))).report.status, Status::not_unique);
  expect_feet(answer_along(overhung(0.2, 0.5), {1, 1}), Uniqueness::refuted, 4, 6);
  expect_feet(answer_along(overhung(0.2, 0.5), {-1, 1}), Uniqueness::refuted, -20, 30);
  EXPECT_EQ(answer(Stepper(overhung(0.2, 2))).report.status, Status::not_unique);
  expect_feet(answer_along(overhung(0.2, 2), {1, -1}), Uniqueness::refuted, 155.0 / 11, -45.0 / 11);
  expect_feet(answer_along(overhung(0.2, 2), {-1, 1}), Uniqueness::refuted, -95, 105);
}

TEST(OverhungSlider, HasOneWhereNoneTurnsIntoTwo) {
  // Exact in binary: a = 1/16, c = 1/2, mu = 1/4, W = 8; the two branches meet in (0, 8) at Me = (mu c - a) W = 1/2.
  Scene scene = overhung(0.25, 0.5);
  scene.gravity = {0, -8};
  scene.body[0].com = {0, 0.5};
  scene.guide[0].contact[0] = {-0.0625, 0};
  scene.guide[0].contact[1] = {0.0625, 0};
  expect_feet(answer(Stepper(scene)), Uniqueness::single, 0, 8);
  scene.load[0].torque = 0.499;
  EXPECT_EQ(answer(Stepper(scene)).report.status, Status::no_solution);
  scene.load[0].torque = 0.501;
  EXPECT_EQ(answer(Stepper(scene)).report.status, Status::not_unique);
}

// --- rod on two guides -----------------------------------------------------------------------------------------------

Scene rod(double mu, double rate) {
  Scene scene = shipped("rod_on_two_guides");
  for (int g = 0; g < 2; ++g) scene.guide[g].mu = scene.guide[g].mu_static = mu;
  for (double& v : scene.body[0].v) v *= rate / 0.1;
  return scene;
}

TEST(RodOnTwoGuides, StartsAsAnIndependentProgramSays) {
  const Answer start = answer(Stepper(rod(0.2, 0.1)));
  ASSERT_EQ(start.report.status, Status::ok);
  EXPECT_EQ(start.report.uniqueness, Uniqueness::certified);
  EXPECT_NEAR(start.reaction.acceleration[2], 1.8394299005, 1e-10);  // rad/s^2; digits given
}

TEST(RodOnTwoGuides, HasThreeAnswersBeyondItsLimit) {
  // tan(15 deg) = 0.267949192431; its neighbours to the scene's own rounding and to more than that.
  EXPECT_TRUE(certified(rod(0.26794919, 1e-6)));
  EXPECT_FALSE(certified(rod(0.26794920, 1e-6)));

  // mu = 0.3 and th' -> 0+: 1e-9 rad/s, of which centripetal terms are 1e-18.
  const Scene scene = rod(0.3, 1e-9);
  EXPECT_EQ(answer(Stepper(scene)).report.status, Status::not_unique);
  struct Row {
    int signs[2];
    double lambda[2], acceleration;
  };
  // Found in exact arithmetic for the project, docs/theory.md.
  const double same = 4.9082864029421594688, more = 10.596908009061298911, less = -0.59801028674709775307;
  for (const Row& row : {Row{{1, 1}, {same, same}, -0.9117250795704905},
                         {{1, -1}, {more, less}, -1.968399152904206},
                         {{-1, 1}, {less, more}, -1.968399152904206}}) {
    const Answer one = answer_along(scene, {row.signs[0], row.signs[1]});
    ASSERT_EQ(one.report.status, Status::ok);
    EXPECT_EQ(one.report.uniqueness, Uniqueness::refuted);
    // Relative: 16 digits of data, ten times their rounding by the nearness of the limit.
    EXPECT_LT(miss(one.reaction.lambda[0], row.lambda[0]), 1e-12);
    EXPECT_LT(miss(one.reaction.lambda[1], row.lambda[1]), 1e-12);
    EXPECT_LT(miss(one.reaction.acceleration[2], row.acceleration), 1e-12);
  }
}

TEST(RodOnTwoGuides, CanBeSteppedAlongOneOfThem) {
  Stepper stepper(rod(0.3, 0.1));
  State state = stepper.start();
  const State before = state;
  EXPECT_EQ(stepper.step(state, 1e-4).status, Status::not_unique);
  EXPECT_TRUE(state == before);
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  state.sign[0] = state.sign[1] = 1;
  const Report report = stepper.step(state, 1e-4);
  EXPECT_EQ(report.status, Status::ok);
  EXPECT_EQ(report.uniqueness, Uniqueness::refuted);
}

// --- elliptic trammel ------------------------------------------------------------------------------------------------

/// The trammel with the rod at an angle, moving on; mass centred.
Scene trammel(double angle, double mu_level, double mu_upright) {
  Scene scene = shipped("elliptic_trammel");
  const double c = std::cos(angle), s = std::sin(angle);
  const double q[3] = {-c, s, angle}, v[3] = {6 * s, 6 * c, 6};
  for (int k = 0; k < 3; ++k) {
    scene.body[0].q[k] = q[k];
    scene.body[0].v[k] = v[k];
  }
  scene.guide[0].mu = scene.guide[0].mu_static = mu_level;
  scene.guide[1].mu = scene.guide[1].mu_static = mu_upright;
  return scene;
}

TEST(EllipticTrammel, IsUniqueAtAnyPoseWhileBothCoefficientsAreBelowOne) {
  const double degree = std::acos(-1.0) / 180;
  for (int angle = 5; angle < 360; angle += 10) EXPECT_TRUE(certified(trammel(angle * degree, 0.999, 0.999))) << angle;
  // docs/theory.md: at 45 degrees the limit for equal coefficients is 1. There the slips' signs that meet it are those
  // of one of the two directions of motion.
  const auto both = [&](double angle, double level, double upright) {
    Scene there = trammel(angle * degree, level, upright), back = there;
    for (double& v : back.body[0].v) v = -v;
    return certified(there) && certified(back);
  };
  EXPECT_TRUE(both(45, 0.999999, 0.999999));
  EXPECT_FALSE(both(45, 1.000001, 1.000001));
  EXPECT_FALSE(both(45, 2, 0.25));
  EXPECT_TRUE(both(5, 1.1, 1.1));
}

// --- driven slider-crank with a point for a slider -------------------------------------------------------------------

/// Crank of length `ratio` at an angle, rod of 1 m, one contact at its end on the line through the bearing.
Scene point_slider(double ratio, double crank_angle, double mu) {
  Scene scene;
  scene.gravity = {0, -9.81};
  scene.bodies = 2;
  scene.body[0].mass = scene.body[0].inertia = 1;
  scene.body[1].parent = 0;
  scene.body[1].at = {ratio, 0};
  scene.body[1].mass = 1;
  scene.body[1].com = {0.5, 0};
  scene.body[1].inertia = 1.0 / 12;
  const double rod = -std::asin(ratio * std::sin(crank_angle));
  scene.body[1].q[0] = rod - crank_angle;
  scene.body[1].v[0] = -10 * ratio * std::cos(crank_angle) / std::cos(rod) - 10;
  scene.drives = 1;
  scene.drive[0].c[0] = scene.body[0].q[0] = crank_angle;
  scene.drive[0].c[1] = scene.body[0].v[0] = 10;
  scene.guides = 1;
  scene.guide[0].slider = 1;
  scene.guide[0].contact[0] = {1, 0};
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  EXPECT_EQ(defects(scene).count, 0);
  return scene;
}

TEST(PointSliderCrank, IsUniqueWhileFrictionTimesTheRodsSlopeIsBelowOne) {
  const double right = std::acos(-1.0) / 2, degree = right / 90;
  // mu = 0.2: tan th2 = 5, ratio 1 / sqrt(1.04) = 0.98058067569092016 at crank angle 90 degrees.
  EXPECT_TRUE(certified(point_slider(0.98058067, right, 0.2)));
  EXPECT_FALSE(certified(point_slider(0.98058068, right, 0.2)));
  // Equal lengths: the rod is as steep as the crank, 78.690 degrees, before the singularity at 90.
  EXPECT_TRUE(certified(point_slider(1, 78.690 * degree, 0.2)));
  EXPECT_FALSE(certified(point_slider(1, 78.691 * degree, 0.2)));
  // What is beyond has none or two answers: n = 1 is decided.
  const Status status = answer(Stepper(point_slider(0.985, right, 0.2))).report.status;
  EXPECT_TRUE(status == Status::no_solution || status == Status::not_unique) << name(status);
}

TEST(PointSliderCrank, WithALightRodIsATwoForceMember) {
  // Point mass m at the rod's end, rod of 1e-12 kg: the rod pushes along itself, so with the slider's acceleration a
  // known from the drive, m a = -lambda cot th2 - mu |lambda| sgn(slip), lambda alone across the line (no weight).
  const double angle = 1.0, ratio = 0.5, mu = 0.2, omega = 10;
  Scene scene = point_slider(ratio, angle, mu);
  scene.gravity = {0, 0};
  scene.body[1].mass = 1e-12;
  scene.body[1].inertia = 1e-13;
  scene.bodies = 3;
  scene.body[2].parent = 1;
  scene.body[2].joint = Joint::fixed;
  scene.body[2].at = {1, 0};
  scene.body[2].mass = 1;
  const double s2 = -ratio * std::sin(angle), c2 = std::sqrt(1 - s2 * s2);  // of the rod
  const double rate = -ratio * omega * std::cos(angle) / c2;
  const double acceleration = (ratio * omega * omega * std::sin(angle) + rate * rate * s2) / c2;
  const double slip = -ratio * omega * std::sin(angle) - rate * s2;
  const double a = -ratio * omega * omega * std::cos(angle) - rate * rate * c2 - acceleration * s2;
  // The end of the rod is at x = ratio cos(angle) + c2; slip and a are its derivatives.
  double lambda = 0;
  for (const int sign : {1, -1}) {
    const double candidate = -a / (c2 / s2 + mu * sign * (slip > 0 ? 1 : -1));
    if (candidate * sign > 0) lambda = candidate;
  }
  const Answer light = answer(Stepper(scene));
  ASSERT_EQ(light.report.status, Status::ok);
  EXPECT_NEAR(light.reaction.slip[0], slip, 1e-14);          // m/s, rounding
  EXPECT_LT(miss(light.reaction.lambda[0], lambda), 1e-11);  // relative; the rod's own 1e-12 kg, and rounding
}

// --- Painleve --------------------------------------------------------------------------------------------------------

/// Painleve and Klein's two sliders on parallel guides, 1 kg each, joined by a light rod of slope tan phi = 3, with
/// friction mu = 1 on the first one's guide, and a force on the first along the guides.
/// With u = -lambda1:  2 u - 3 |u| = r,  r = -3 force.
Scene two_sliders(double force) {
  Scene scene;
  scene.bodies = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = 2;
  scene.body[0].com = {0.5, 1.5};
  scene.body[0].inertia = 5;  // m1 m2 / (m1 + m2) times the rod's length squared, 10
  scene.body[0].v[0] = 1;
  scene.guides = 2;
  scene.guide[0].mu = scene.guide[0].mu_static = 1;
  scene.guide[1].origin = {0, 3};
  scene.guide[1].contact[0] = {1, 3};
  scene.loads = 1;
  scene.load[0].force = {force, 0};
  EXPECT_EQ(defects(scene).count, 0);
  return scene;
}

TEST(PainleveKlein, HasTwoAnswersOneWayAndNoneTheOther) {
  const double force = 1.0 / 3;
  EXPECT_EQ(answer(Stepper(two_sliders(-force))).report.status, Status::no_solution);  // r = 1
  EXPECT_EQ(answer(Stepper(two_sliders(force))).report.status, Status::not_unique);    // r = -1: u = 1 and -1/5
  const Answer one = answer_along(two_sliders(force), {-1}), two = answer_along(two_sliders(force), {1});
  ASSERT_EQ(one.report.status, Status::ok);
  ASSERT_EQ(two.report.status, Status::ok);
  EXPECT_EQ(one.report.uniqueness, Uniqueness::refuted);
  EXPECT_LT(miss(one.reaction.lambda[0], -1), 1e-12);  // relative, rounding
  EXPECT_LT(miss(one.reaction.lambda[1], 1), 1e-12);   // nothing else acts across the guides
  EXPECT_LT(miss(two.reaction.lambda[0], 0.2), 1e-12);
  EXPECT_LT(miss(two.reaction.acceleration[0], (force - 0.2) / 2), 1e-12);
  // Unique below mu tan phi = 1 + m1 / m2 = 2.
  Scene scene = two_sliders(force);
  scene.guide[0].mu = scene.guide[0].mu_static = 0.6666;
  EXPECT_TRUE(certified(scene));
  scene.guide[0].mu = scene.guide[0].mu_static = 0.6667;
  EXPECT_FALSE(certified(scene));
}

/// A rod that turns freely about a bead on a straight wire; 1 kg at 1 m from the bead, inertia k about the centre.
Scene rod_on_bead(double k, double angle, double mu) {
  Scene scene;
  scene.gravity = {0, -9.81};
  scene.bodies = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = 1;
  scene.body[0].com = {1, 0};
  scene.body[0].inertia = k;
  scene.body[0].q[2] = angle;
  scene.body[0].v[0] = 1;
  scene.guides = 1;
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  EXPECT_EQ(defects(scene).count, 0);
  return scene;
}

TEST(PainleveRod, IsUniqueAtAnyAngleBelowItsCriticalFriction) {
  // mu = 2 sqrt(k (k + 1)), first reached where tan th = sqrt((k + 1) / k).
  const double third = 1.0 / 3;
  const double critical = std::atan(2.0);  // 63.4349488 degrees
  EXPECT_TRUE(certified(rod_on_bead(third, critical, 4.0 / 3 - 1e-9)));
  EXPECT_FALSE(certified(rod_on_bead(third, critical, 4.0 / 3 + 1e-9)));
  EXPECT_TRUE(certified(rod_on_bead(third, critical + 0.01, 4.0 / 3 + 1e-9)));
  const double thin = std::atan(std::sqrt(101.0));
  EXPECT_TRUE(certified(rod_on_bead(0.01, thin, 0.200997512)));  // 0.2009975124224178
  EXPECT_FALSE(certified(rod_on_bead(0.01, thin, 0.200997513)));
  for (int degree = -175; degree < 180; degree += 10) {
    EXPECT_TRUE(certified(rod_on_bead(third, degree * std::acos(-1.0) / 180, 1.33))) << degree;
  }
}

}  // namespace
