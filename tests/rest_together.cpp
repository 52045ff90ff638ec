// Several guides at rest, or coming to rest, at one instant: what is known of each alone, and of the forces that they
// share. Room for three guides, and hardly more.
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/step.hpp>
#include <utility>

namespace {

using slideway::Joint;
using slideway::Law;
using slideway::Method;
using slideway::none;
using slideway::Report;
using slideway::Scene;
using slideway::Status;
using slideway::Uniqueness;

using Size = slideway::Size<3, 9, 3, 3, 2, 0, 0, 0, 3, 0>;
using Stepper = slideway::RunTimeStepper<Size>;

constexpr double g = 10;         // m/s^2
constexpr double dt = 0x1p-10;   // s
constexpr double exact = 1e-13;  // N, m/s^2: some hundred roundings of forces of about 10 N
// N, m/s^2. Where forces are a choice their limits are met to 4 rank_bound() of the largest, 32 eps a free coordinate:
// 2.9e-13 for 10 N and four coordinates. Three guides share that.
constexpr double chosen = 1e-12;

auto reaction_of(const Stepper& stepper, const Stepper::State& state, Report& report) {
  Stepper::Reaction r{};
  report = stepper.reaction(state, {}, r);
  return r;
}

auto reaction_of(const Stepper& stepper, const Stepper::State& state) {
  Report report;
  const auto r = reaction_of(stepper, state, report);
  EXPECT_EQ(report.status, Status::ok) << sentence(report.status);
  return r;
}

// --- blocks that know nothing of each other --------------------------------------------------------------------------

/// Blocks of 1 kg on the x axis, each on one contact at its centre of mass and pushed there: 10 N of weight, so that
/// 5 N of friction slow it and 6 N hold it.
template <int Count>
Scene<Size> blocks(const double (&push)[Count]) {
  Scene<Size> scene;
  scene.gravity = {0, -g};
  scene.bodies = scene.guides = scene.loads = Count;
  for (int i = 0; i < Count; ++i) {
    scene.body[i].joint = Joint::planar;
    scene.body[i].mass = scene.body[i].inertia = 1;
    scene.guide[i].slider = scene.load[i].body = i;
    scene.guide[i].mu = 0.5;
    scene.guide[i].mu_static = 0.6;
    scene.load[i].force = {push[i], 0};
  }
  return scene;
}

/// A state whose modes are given, as an event leaves them.
template <int Count>
auto with_modes(const Stepper& stepper, const signed char (&mode)[Count]) {
  auto state = stepper.start();
  for (int i = 0; i < Count; ++i) {
    state.mode[i] = mode[i];
    state.sign[i] = 1;
  }
  state.decided = true;
  return state;
}

TEST(BlockAtRest, WithASlipDirectionThatGainsItNoSpeedDoesNotSlipThatWay) {
  struct Case {
    double push, friction;
  };
  // Held by what is pushed; with the push; between mu and mu_static, where a block that leaves goes on; against it.
  for (const Case& c :
       {Case{2, -2}, Case{0, 0}, Case{7, -5}, Case{5.5, -5}, Case{-2, 2}, Case{-5.5, 5.5}, Case{-7, 5}}) {
    const Stepper stepper(blocks<1>({c.push}));
    const auto r = reaction_of(stepper, with_modes(stepper, {1}));
    EXPECT_NEAR(r.friction[0], c.friction, exact) << c.push << " N";
    EXPECT_NEAR(r.acceleration[0], c.push + c.friction, exact) << c.push << " N";
  }
}

TEST(BlockAtRest, ThatLeavesSlidesWithMuWhateverAnotherDoesAtThatInstant) {
  // One comes with a slip direction that nothing pushes it along, and rests; the other is pushed beyond mu_static.
  for (const int pushed : {0, 1}) {
    double push[2] = {0, 0};
    signed char mode[2] = {1, 1};
    push[pushed] = 8;
    mode[pushed] = 0;
    const Stepper stepper(blocks<2>(push));
    const auto r = reaction_of(stepper, with_modes(stepper, mode));
    EXPECT_NEAR(r.friction[pushed], -5, exact);
    EXPECT_NEAR(r.acceleration[3 * pushed], 3, exact);
    EXPECT_NEAR(r.friction[1 - pushed], 0, exact);
    EXPECT_NEAR(r.acceleration[3 * (1 - pushed)], 0, exact);
  }
}

TEST(BlocksAtRest, NameNoGuideWhereNothingIsAmiss) {
  const Stepper stepper(blocks<2>({1, 7}));
  for (const Method method : slideway::methods) {
    if (method == Method::kinematic) continue;
    Stepper made = stepper;
    made.method = method;
    auto state = made.start();
    for (int k = 0; k < 3; ++k) {
      const Report report = made.step(state, dt);
      ASSERT_EQ(report.status, Status::ok) << name(method);
      EXPECT_EQ(report.guide, none) << name(method);
    }
  }
}

/// Two blocks that slide at 1 m/s; the first is slowed by 5 m/s^2 and stops after 0.2 s, the second is pushed on.
TEST(BlockThatStops, LeavesTheOthersSpeedAlone) {
  const double push[2] = {0, 5};
  for (const int stops : {0, 1}) {
    auto scene = blocks<2>(push);
    if (stops == 1) std::swap(scene.load[0].force, scene.load[1].force);
    scene.body[0].v[0] = scene.body[1].v[0] = 1;
    for (const Method method : slideway::methods) {
      if (method == Method::kinematic) continue;
      Stepper stepper(scene);
      stepper.method = method;
      auto state = stepper.start();
      for (int k = 0; k < 300; ++k) ASSERT_EQ(stepper.step(state, dt).status, Status::ok) << name(method);
      EXPECT_EQ(state.mode[stops], 0) << name(method);
      EXPECT_EQ(state.mode[1 - stops], 1) << name(method);
      EXPECT_EQ(state.v[3 * stops], 0) << name(method);  // 1 kg: what it loses is what it had, without rounding
      EXPECT_NEAR(state.v[3 * (1 - stops)], 1, exact) << name(method);
    }
  }
}

/// Two blocks that come to speed zero in one step: one stays, the other is pushed back at once.
TEST(BlocksThatStopInOneStep, StayOrTurnBackEachByItself) {
  for (const int stays : {0, 1}) {
    double push[2] = {-8, -8};
    push[stays] = -1;
    auto scene = blocks<2>(push);
    // From 6 and 13 m/s^2 of deceleration: both are at speed zero between step 8 and 9.
    scene.body[stays].v[0] = 6 * 8.5 * dt;
    scene.body[1 - stays].v[0] = 13 * 8.5 * dt;
    for (const Method method : {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located}) {
      Stepper stepper(scene);
      stepper.method = method;
      auto state = stepper.start();
      for (int k = 0; k < 20; ++k) ASSERT_EQ(stepper.step(state, dt).status, Status::ok) << name(method);
      EXPECT_EQ(state.mode[stays], 0) << name(method);
      EXPECT_NEAR(state.v[3 * stays], 0, 1e-15) << name(method);
      EXPECT_EQ(state.mode[1 - stays], -1) << name(method);
      // Back by 8 - 5 = 3 m/s^2 for 11.5 steps; what is not located may be off by a step.
      const double speed = -3 * 11.5 * dt;
      EXPECT_NEAR(state.v[3 * (1 - stays)], speed, is_located(method) ? exact : 16 * dt) << name(method);
    }
  }
}

// --- guides that share one motion ------------------------------------------------------------------------------------

/// A block of 2 kg on two guides with one contact each, at -1 and 1 m, and a head of 1 kg that can slide up and down in
/// it, on a guide of its own: all on the x axis, pushed there. 10 N on each guide, one degree of freedom.
///
/// The guides' order is free: `place[0]` and `place[1]` are those of the block, `place[2]` is the head's.
Scene<Size> block_with_head(double push, const int (&place)[3]) {
  Scene<Size> scene;
  scene.gravity = {0, -g};
  scene.bodies = 2;
  scene.guides = 3;
  scene.loads = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = scene.body[0].inertia = 2;
  scene.body[1].parent = 0;
  scene.body[1].joint = Joint::prismatic;
  scene.body[1].angle = 0.5 * 3.14159265358979323846;
  scene.body[1].turn = {0, 1};
  scene.body[1].mass = 1;
  for (int i = 0; i < 3; ++i) {
    slideway::Guide& guide = scene.guide[place[i]];
    guide.slider = i < 2 ? 0 : 1;
    if (i < 2) guide.contact[0] = {i == 0 ? -1.0 : 1.0, 0};
    guide.mu = guide.mu_static = 0.5;
  }
  scene.load[0].force = {push, 0};
  return scene;
}

constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

TEST(ThreeGuidesAtRest, ShareTheirStictionByLeastNorm) {
  for (const auto& place : orders) {
    // 6 N over three guides that may give 5 N each.
    auto scene = block_with_head(6, place);
    Report report;
    const Stepper alike(scene);
    auto r = reaction_of(alike, alike.start(), report);
    ASSERT_EQ(report.status, Status::ok);
    EXPECT_EQ(report.uniqueness, Uniqueness::motion_only);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(r.lambda[place[i]], 10, chosen);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(r.friction[place[i]], -2, chosen);
    // The head's guide is limited to 1 N: the others share what is left.
    scene.guide[place[2]].mu = scene.guide[place[2]].mu_static = 0.1;
    const Stepper limited(scene);
    r = reaction_of(limited, limited.start());
    EXPECT_NEAR(r.friction[place[2]], -1, chosen);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(r.friction[place[i]], -2.5, chosen);
    // One of the block's to 1 N as well.
    scene.guide[place[0]].mu = scene.guide[place[0]].mu_static = 0.1;
    const Stepper twice(scene);
    r = reaction_of(twice, twice.start());
    EXPECT_NEAR(r.friction[place[0]], -1, chosen);
    EXPECT_NEAR(r.friction[place[2]], -1, chosen);
    EXPECT_NEAR(r.friction[place[1]], -4, chosen);
  }
}

TEST(ThreeGuidesAtRest, HoldWhatTheirLimitsAddUpToAndNoMore) {
  for (const auto& place : orders) {
    // 5 + 5 + 5 N; all directions.
    for (const double side : {1.0, -1.0}) {
      const Stepper held(block_with_head(14.5 * side, place));
      auto r = reaction_of(held, held.start());
      EXPECT_NEAR(r.acceleration[0], 0, chosen);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(r.friction[i], -14.5 / 3 * side, chosen);
      const Stepper slips(block_with_head(16.5 * side, place));
      r = reaction_of(slips, slips.start());
      EXPECT_NEAR(r.acceleration[0], 0.5 * side, chosen);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(r.friction[i], -5 * side, chosen);
    }
  }
}

TEST(ThreeGuidesAtRest, StayThereByEveryMethodAndLeaveTogether) {
  for (const Method method : slideway::methods) {
    if (method == Method::kinematic) continue;
    Stepper stepper(block_with_head(6, orders[0]));
    stepper.method = method;
    auto state = stepper.start();
    for (int k = 0; k < 100; ++k) ASSERT_EQ(stepper.step(state, dt).status, Status::ok) << name(method);
    EXPECT_NEAR(state.q[0], 0, 1e-15) << name(method);
    Stepper leaving(block_with_head(18, orders[0]));
    leaving.method = method;
    state = leaving.start();
    for (int k = 0; k < 100; ++k) ASSERT_EQ(leaving.step(state, dt).status, Status::ok) << name(method);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(state.mode[i], 1) << name(method);
    EXPECT_NEAR(state.v[0], 100 * dt, chosen) << name(method);  // 3 kg by 18 - 15 N
  }
}

/// A block of 1 kg with one foot on the ground and one on a carriage beside it, that starts off with `acceleration`:
/// 5 N on each foot.
Scene<Size> block_on_carriage(double acceleration, double mu_ground, double mu_carriage) {
  Scene<Size> scene;
  scene.gravity = {0, -g};
  scene.alpha = scene.beta = 0;  // there is no drift but what Runge and Kutta's stages would have it see
  scene.bodies = scene.guides = 2;
  scene.drives = 1;
  scene.body[0].joint = Joint::prismatic;
  scene.body[0].mass = 1;
  scene.body[1].joint = Joint::planar;
  scene.body[1].mass = scene.body[1].inertia = 1;
  scene.drive[0].law = Law::polynomial;
  scene.drive[0].terms = 3;
  scene.drive[0].c[2] = 0.5 * acceleration;
  for (int i = 0; i < 2; ++i) {
    scene.guide[i].slider = 1;
    scene.guide[i].contact[0] = {i == 0 ? -1.0 : 1.0, 0};
    scene.guide[i].mu = scene.guide[i].mu_static = i == 0 ? mu_ground : mu_carriage;
  }
  scene.guide[1].rail = 0;
  return scene;
}

TEST(GuidesAtRestThatPart, AreHeldByOneOrNeither) {
  struct Case {
    double acceleration, mu_ground, mu_carriage;
    double of_block, on_ground, on_carriage;  ///< acceleration, frictions
  };
  // It stays on the ground; goes with the carriage; slides on both.
  for (const double side : {1.0, -1.0}) {
    for (const Case& c : {Case{3, 0.5, 0.2, 0, -1, 1}, Case{1, 0.2, 0.5, 1, -1, 2}, Case{3, 0.2, 0.5, 1.5, -1, 2.5}}) {
      const Stepper stepper(block_on_carriage(side * c.acceleration, c.mu_ground, c.mu_carriage));
      const auto r = reaction_of(stepper, stepper.start());
      EXPECT_NEAR(r.acceleration[1], side * c.of_block, exact);
      EXPECT_NEAR(r.friction[0], side * c.on_ground, exact);
      EXPECT_NEAR(r.friction[1], side * c.on_carriage, exact);
      EXPECT_NEAR(r.drive[0], side * (c.acceleration + c.on_carriage), exact);
      for (const Method method : {Method::rk4_located, Method::dop853_located}) {
        Stepper located = stepper;
        located.method = method;
        auto state = located.start();
        for (int k = 0; k < 64; ++k) ASSERT_EQ(located.step(state, dt).status, Status::ok) << name(method);
        EXPECT_NEAR(state.v[1], side * c.of_block * 64 * dt, exact) << name(method);
      }
    }
  }
}

}  // namespace
