// Where methods fail: every case of the kind has a scene, and gets the right status or the right number.
#include <gtest/gtest.h>

#include <cmath>
#include <support/steppers.hpp>

namespace {

using namespace slideway;
using namespace slideway::test;

struct Case {
  const char* name;
  const char* scene;
  std::vector<std::string> settings;
  Status status;  ///< at the start
  int guide;      ///< named; none
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::vector<Case> cases = {
    {"block", "block_on_plane", {}, Status::ok, none},
    {"block_jams", "block_on_plane", {"guide.plane.mu=1.5"}, Status::no_solution, 0},
    {"overhung_below", "overhung_slider", {"guide.way.mu=0.16"}, Status::ok, none},
    {"overhung_two", "overhung_slider", {"guide.way.mu=0.2"}, Status::not_unique, 0},
    {"overhung_two_more", "overhung_slider", {"guide.way.mu=0.2", "load.load1.torque=2"}, Status::not_unique, 0},
    {"overhung_none", "overhung_slider", {"guide.way.mu=0.2", "load.load1.torque=0.05"}, Status::no_solution, 0},
    {"rod_below", "rod_on_two_guides", {"guide.flat.mu=0.267", "guide.inclined.mu=0.267"}, Status::ok, none},
    {"rod_three", "rod_on_two_guides", {"guide.flat.mu=0.3", "guide.inclined.mu=0.3"}, Status::not_unique, 0},
    {"trammel_none", "elliptic_trammel", {"guide.level.mu=2", "guide.upright.mu=0.25"}, Status::no_solution, 0},
    {"klein_below", "painleve_klein", {"guide.rough.mu=0.999"}, Status::ok, none},
    {"klein_two", "painleve_klein", {"guide.rough.mu=1.5"}, Status::not_unique, 0},
    {"klein_none", "painleve_klein", {"guide.rough.mu=1.5", "load.push.force=[-0.5, 0]"}, Status::no_solution, 0},
    {"painleve_below", "painleve_rod", {"guide.wire.mu=1.33"}, Status::ok, none},
    {"painleve_two", "painleve_rod", {"guide.wire.mu=1.5"}, Status::not_unique, 0},
    {"painleve_none", "painleve_rod", {"guide.wire.mu=1.5", "body.rod.v=[-4, 0, 0]"}, Status::no_solution, 0},
    {"three_contacts", "three_contacts", {}, Status::singular_constraints, none},
    {"equal_cranks", "slider_crank_equal", {}, Status::ok, none},
    {"high_mass_ratio", "high_mass_ratio", {}, Status::ok, none},
    {"pushed", "pushed_block", {}, Status::ok, none},
    {"trammel_rests_or_moves", "trammel_at_rest", {"load.push.torque=9"}, Status::not_unique, 0}};

class Failures : public testing::TestWithParam<Case> {};

TEST_P(Failures, GetTheRightStatusFromEveryMethod) {
  const Case& c = GetParam();
  for (const Method method : {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located}) {
    const RunStepper stepper = stepper_of(c.scene, method, c.settings);
    RunState state = stepper.start();
    const Report report = stepper.step(state, 1e-5);
    EXPECT_EQ(report.status, c.status) << name(method) << ": " << name(report.status);
    if (c.status != Status::ok) {
      EXPECT_TRUE(state == stepper.start());
    }
    if (c.guide != none) {
      EXPECT_EQ(report.guide, c.guide) << name(method);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Failures, testing::ValuesIn(cases),
                         [](const auto& one) { return std::string(one.param.name); });

/// Refused on the way, at the step that begins at `t`, by every method.
void expect_refusal_on_the_way(const char* scene, const std::vector<std::string>& settings, double dt, double t,
                               Status status) {
  for (const Method method : {Method::rk4, Method::rk4_located, Method::dop853_located}) {
    const RunStepper stepper = stepper_of(scene, method, settings);
    const History r = run(stepper, stepper.start(), dt, std::lround(2 * t / dt));
    EXPECT_EQ(r.last.status, status) << scene << " " << name(method) << ": " << name(r.last.status);
    EXPECT_NEAR(r.state.time(), t, 2 * dt) << scene << " " << name(method);
  }
}

TEST(FailuresOnTheWay, AreRefusedThere) {
  expect_refusal_on_the_way("slider_crank_driven", {"guide.way.mu=1.8"}, 1e-3, 0.054, Status::not_unique);
  expect_refusal_on_the_way("slider_crank_equal", {}, 1e-3, 0.294, Status::not_unique);  // limit 0.29400130177 s
  expect_refusal_on_the_way("painleve_rod", {"guide.wire.mu=1.5", "body.rod.q=[0, 0, 1.4]"}, 1e-3, 0.104,
                            Status::not_unique);
}

TEST(AStepOverAllPosesWithoutAnAnswer, IsRefusedOrSaysThatItTurnedFar) {
  // Between atan(5) and its mirror image, from 0.0588 to 0.0982 s, there is no solution.
  const std::vector<std::string> settings = {"drive.motor.rate=10", "body.rod.v=[-20]"};
  for (const Method method : methods) {
    const RunStepper stepper = stepper_of("slider_crank_equal", method, settings);
    RunState state = stepper.start();
    const Report over = stepper.step(state, 0.11);
    if (is_located(method)) {
      EXPECT_EQ(over.status, Status::singular_constraints) << name(method) << ": " << name(over.status);
    } else {
      EXPECT_EQ(over.status, Status::ok) << name(method) << ": " << name(over.status);
      EXPECT_GE(over.unlocated_events, 1) << name(method);
    }
    state = stepper.start();  // the rod turns by 0.4 rad
    const Report before = stepper.step(state, 0.02);
    EXPECT_EQ(before.status, Status::ok) << name(method) << ": " << name(before.status);
    EXPECT_EQ(before.unlocated_events, 0) << name(method);
  }
}

TEST(CloseContacts, HaveSixDigitsOrAreRefused) {
  // A moment of 0.5 N m on feet at -+a, all but without friction. Of the product of the feet's squared row lengths,
  // 1 + a^2 / J each, 4 a^2 / J is left, J = 0.01: 2^-30 of two such products at 2.2e-6 m.
  for (const double a : {1e-3, 1e-4, 1e-5, 2.5e-6, 2e-6, 1e-6, 1e-7}) {
    RunStepper stepper = stepper_of("overhung_slider", Method::rk4, {"guide.way.mu=1e-12"});
    for (int k = 0; k < 2; ++k) stepper.source.scene.guide[0].contact[k].x = k == 0 ? -a : a;
    stepper = RunStepper(stepper.source.scene);
    RunStepper::Reaction r;
    const Status status = stepper.reaction(stepper.start(), {}, r).status;
    EXPECT_EQ(status, a < 2.2e-6 ? Status::singular_constraints : Status::ok) << a << ' ' << name(status);
    if (status == Status::ok) {
      EXPECT_NEAR(r.lambda[0] - r.lambda[1], 0.5 / a, 1e-6 * 0.5 / a) << a;
    }
  }
}

TEST(Continuing, GoesAlongTheSignsAndNamesTheGuide) {
  // docs/theory.md: feet (4, 6) N are followed, and it says so.
  for (const Method method : {Method::rk4, Method::rk4_located, Method::dop853_located}) {
    RunStepper stepper = stepper_of("overhung_slider", method, {"guide.way.mu=0.2"});
    stepper.hlcp.not_unique = NotUnique::continue_along_signs;
    RunState state = stepper.start();
    for (int k = 0; k < 100; ++k) {
      const Report report = stepper.step(state, 1e-3);
      ASSERT_EQ(report.status, Status::ok) << name(method);
      EXPECT_EQ(report.uniqueness, Uniqueness::refuted);
      EXPECT_EQ(report.guide, 0);
    }
    RunStepper::Reaction r;
    ASSERT_EQ(stepper.reaction(state, {}, r).status, Status::ok);
    EXPECT_NEAR(r.lambda[0], 4, 1e-9);
    EXPECT_NEAR(r.lambda[1], 6, 1e-9);
  }
}

TEST(EqualCranks, PassTheSingularPoseWithoutFriction) {
  RunStepper stepper = stepper_of("slider_crank_equal", Method::rk4_located, {"guide.way.mu=0"});
  const History r = run(stepper, stepper.start(), 1e-3, 800);
  EXPECT_EQ(r.last.status, Status::ok) << sentence(r.last.status);
}

TEST(Chain, IsRefusedLevel) {
  const RunStepper chain = stepper_of("four_bar_chain", Method::rk4_located);
  RunState level = chain.start();
  for (int j = 0; j < 9; ++j) level.q[j] = 0;
  EXPECT_EQ(chain.step(level, 1e-3).status, Status::singular_constraints);
}

TEST(Projection, HoldsTheConstraintsAsBaumgarteDoesAndTighter) {
  for (const Method method : integrating) {
    RunStepper stepper = stepper_of("crank_rocker_offset", method);
    stepper.stabilise = Stabilise::projection;
    const History r = run(stepper, stepper.start(), 1e-3, 1000);
    ASSERT_EQ(r.last.status, Status::ok) << name(method) << sentence(r.last.status);
    RunStepper::Reaction reaction;
    stepper.method = Method::rk4;  // moreau's reaction looks ahead
    const Report at_end = stepper.reaction(r.state, {}, reaction);
    // 16 eps (bodies + 1) times a distance of some meters: project.hpp.
    EXPECT_LT(at_end.drift_position, 16 * 0x1p-52 * 4 * 5) << name(method);
    EXPECT_LT(at_end.drift_velocity, method == Method::moreau ? 1e-3 : 1e-13) << name(method);  // at q_m: of order dt
  }
}

TEST(Projection, KeepsAGuideAtRestWhereItIs) {
  for (const Method method : integrating) {
    RunStepper stepper = stepper_of("pushed_block", method);
    stepper.stabilise = Stabilise::projection;
    const History r = run(stepper, stepper.start(), 1e-3, 10000);
    ASSERT_EQ(r.last.status, Status::ok);
    EXPECT_LT(std::fabs(r.state.q[0]), 1e-13) << name(method);
  }
}

}  // namespace
