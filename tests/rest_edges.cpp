// A guide at rest at the edges of Coulomb's law: at its limit, beside large preloads, with whatever signs came before,
// and where friction cannot change its motion. Scenes have the room for guides that they need, and hardly more.
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/step.hpp>

namespace {

using slideway::Joint;
using slideway::Law;
using slideway::Method;
using slideway::none;
using slideway::NotUnique;
using slideway::Report;
using slideway::Scene;
using slideway::Status;
using slideway::Uniqueness;

/// Blocks of 1 kg on two feet of one guide, and a load on each.
using BlockSize = slideway::Size<2, 6, 2, 4, 2, 0, 0, 0, 2, 0>;
using Stepper = slideway::RunTimeStepper<BlockSize>;
using State = Stepper::State;
using Reaction = Stepper::Reaction;

constexpr double dt = 0x1p-10;   // s
constexpr double exact = 1e-13;  // N, m/s^2: some hundred roundings of forces of about 10 N

/// Feet at -a and a on the x axis, centre of mass at height c, where the load acts. 10 N of weight.
Scene<BlockSize> block(double a, double c, double mu, double push, double torque) {
  Scene<BlockSize> scene;
  scene.gravity = {0, -10};
  scene.bodies = scene.guides = scene.loads = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = 1;
  scene.body[0].inertia = 0.25;
  scene.body[0].com = {0, c};
  scene.guide[0].contacts = 2;
  scene.guide[0].contact[0] = {-a, 0};
  scene.guide[0].contact[1] = {a, 0};
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  scene.load[0].at = {0, c};
  scene.load[0].force = {push, 0};
  scene.load[0].torque = torque;
  return scene;
}

/// A decided state at rest, as another step may have left it.
State at_rest(const Stepper& stepper, signed char sign_0, signed char sign_1) {
  State state = stepper.start();
  state.sign[0] = sign_0;
  state.sign[1] = sign_1;
  state.decided = true;
  return state;
}

constexpr signed char both[2] = {1, -1};

TEST(AtItsLimit, ABlockRestsWhateverHoldsIt) {
  // By friction alone, mu below and above 1; by preload alone; by both.
  struct Case {
    double mu, preload, push;
  };
  for (const Case& c : {Case{0.5, 0, 5}, Case{2, 0, 20}, Case{8, 0, 80}, Case{0, 4, 4}, Case{0.5, 1000, 1005}}) {
    for (const double side : {1.0, -1.0}) {
      Scene<BlockSize> scene = block(0.25, 0, c.mu, side * c.push, 0);
      scene.guide[0].preload = c.preload;
      for (const Method method : slideway::methods) {
        if (method == Method::kinematic) continue;
        Stepper stepper(scene);
        stepper.method = method;
        State state = stepper.start();
        int events = 0, most = 0;
        for (int k = 0; k < 100; ++k) {
          const Report report = stepper.step(state, dt);
          ASSERT_EQ(report.status, Status::ok) << name(method) << ", mu " << c.mu << ": " << sentence(report.status);
          events += report.events + report.unlocated_events;
          most = report.evaluations > most ? report.evaluations : most;
        }
        EXPECT_EQ(events, 0) << name(method) << ", mu " << c.mu;
        EXPECT_EQ(state.mode[0], 0) << name(method) << ", mu " << c.mu;
        // m; 0.1 s beside some roundings of the push, at most.
        EXPECT_LT(std::fabs(state.q[0]), 0.01 * 64 * 0x1p-52 * c.push) << name(method) << ", mu " << c.mu;
        // Nothing happens: a step and a look at where it ends.
        EXPECT_LE(most, method == Method::dop853_located ? 13 : 5) << name(method) << ", mu " << c.mu;
      }
    }
  }
}

TEST(AboveItsLimit, ABlockLeavesWhateverHoldsIt) {
  struct Case {
    double mu, preload, limit;
  };
  for (const Case& c : {Case{0.5, 0, 5}, Case{2, 0, 20}, Case{8, 0, 80}, Case{0, 4, 4}, Case{0.5, 1000, 1005}}) {
    for (const double side : {1.0, -1.0}) {
      const double push = c.limit * (1 + 0x1p-30);
      Scene<BlockSize> scene = block(0.25, 0, c.mu, side * push, 0);
      scene.guide[0].preload = c.preload;
      const Stepper stepper(scene);
      Reaction r{};
      ASSERT_EQ(stepper.reaction(stepper.start(), {}, r).status, Status::ok);
      // N; some hundred roundings of the limit.
      EXPECT_NEAR(r.friction[0], -side * c.limit, 256 * 0x1p-52 * c.limit);
      EXPECT_NEAR(r.acceleration[0], side * (push - c.limit), 256 * 0x1p-52 * c.limit);
    }
  }
}

TEST(ABlockThatLeaves, DoesSoWhateverTheSignsWere) {
  // mu c = a: pushed by 8 N with 2 N m, the feet carry 4 and 6 N (docs/theory.md, overhung slider). With a negative
  // force on one of them, friction's moment changes as the feet's does, and the equations of those signs are singular.
  const Stepper stepper(block(0.25, 0.5, 0.5, 8, 2));
  for (const signed char first : both)
    for (const signed char second : both) {
      Reaction r{};
      const Report report = stepper.reaction(at_rest(stepper, first, second), {}, r);
      ASSERT_EQ(report.status, Status::ok) << int{first} << " " << int{second} << ": " << sentence(report.status);
      EXPECT_NEAR(r.lambda[0], 4, exact);
      EXPECT_NEAR(r.lambda[1], 6, exact);
      EXPECT_NEAR(r.friction[0], -5, exact);
      EXPECT_NEAR(r.acceleration[0], 3, exact);
    }
}

TEST(ABlockThatMayRestOrLeave, GoesOnWithTheSignsThatItHad) {
  // mu c = 2 a, pushed by 8 N with 3 N m. It may rest, on -5 and 15 N; leave with 1 and 9 N, by 3 m/s^2; or with -1 and
  // 11 N, by 2 m/s^2.
  Stepper stepper(block(0.25, 1, 0.5, 8, 3));
  Reaction r{};
  const Report refused = stepper.reaction(stepper.start(), {}, r);
  EXPECT_EQ(refused.status, Status::not_unique);
  EXPECT_EQ(refused.guide, 0);
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  const Report report = stepper.reaction(at_rest(stepper, -1, 1), {}, r);
  ASSERT_EQ(report.status, Status::ok);
  EXPECT_EQ(report.uniqueness, Uniqueness::refuted);
  EXPECT_EQ(report.guide, 0);
  EXPECT_NEAR(r.lambda[0], -5, exact);
  EXPECT_NEAR(r.lambda[1], 15, exact);
  EXPECT_NEAR(r.friction[0], -8, exact);
  EXPECT_NEAR(r.acceleration[0], 0, exact);
}

TEST(ABlockBesideALargePreload, HasTheSignsOfItsForces) {
  // 1e6 N of preload, and 1e-13 N on the feet, which the equations of the preload cannot tell from zero: 1/3 N of push
  // low on the block, its moment balanced by the torque.
  for (const double weight : {1e-13, -1e-13}) {
    for (const double push : {1.0 / 3, -1.0 / 3, 1.0 / 7, -1.0 / 7}) {
      Scene<BlockSize> scene = block(0.25, 0.5, 0.5, push, 0);
      scene.gravity.y = -weight;
      scene.guide[0].preload = 1e6;
      scene.load[0].at = {0, 0};
      scene.beta = 0;  // of drift that there is none of, rounding would be 1e-14 m/s^2
      Stepper stepper(scene);
      State state = stepper.start();
      ASSERT_EQ(stepper.step(state, dt).status, Status::ok);
      EXPECT_EQ(state.mode[0], 0);
      for (int c = 0; c < 2; ++c) EXPECT_EQ(state.sign[c], weight > 0 ? 1 : -1) << push << ", foot " << c;
    }
  }
}

TEST(ABlockThatIsDriven, HasKineticFrictionAgainstWhereItIsGoing) {
  // At its turning point it has no speed, but friction cannot keep it there: mu, not mu_static.
  for (const double acceleration : {1.0, -3.0}) {
    Scene<BlockSize> scene = block(0.25, 0, 0.5, 0, 0);
    scene.guide[0].mu_static = 0.75;
    scene.drives = 1;
    scene.drive[0].law = Law::polynomial;
    scene.drive[0].terms = 3;
    scene.drive[0].c[2] = 0.5 * acceleration;
    const Stepper stepper(scene);
    for (const int mode : {0, 1, -1}) {
      State state = at_rest(stepper, 1, 1);
      state.mode[0] = static_cast<signed char>(mode);
      Reaction r{};
      ASSERT_EQ(stepper.reaction(state, {}, r).status, Status::ok);
      EXPECT_NEAR(r.friction[0], acceleration > 0 ? -5 : 5, exact) << mode;
      EXPECT_NEAR(r.drive[0], acceleration + (acceleration > 0 ? 5 : -5), exact) << mode;
    }
  }
}

TEST(AContactForceThatIsZero, HasTheSignThatItHad) {
  // No weight: a block that slides on feet that carry nothing. Each keeps its face.
  for (const signed char first : both)
    for (const signed char second : both) {
      Scene<BlockSize> scene = block(0.25, 0.125, 0.5, 0, 0);
      scene.gravity.y = 0;
      scene.body[0].v[0] = 1;
      for (const Method method : {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located}) {
        Stepper stepper(scene);
        stepper.method = method;
        State state = at_rest(stepper, first, second);
        state.mode[0] = 1;
        for (int k = 0; k < 3; ++k) ASSERT_EQ(stepper.step(state, dt).status, Status::ok);
        EXPECT_EQ(state.sign[0], first) << name(method);
        EXPECT_EQ(state.sign[1], second) << name(method);
      }
    }
}

TEST(AContactForceAboveItsRounding, HasASignOfItsOwn) {
  // acceleration.hpp: -beta Phi is known to 4 eps beta length (bodies + 1), here 2^-49 beta for 1 kg. With an eighth
  // more the forces count, with an eighth of it they are rounding.
  const double beta = 0x1p20, rounding = 0x1p-49 * beta;
  const auto sign_of = [&](double weight, signed char before) {
    Scene<BlockSize> scene = block(1, 0, 0.5, 0, 0);
    scene.alpha = 0;
    scene.beta = beta;
    scene.guide[0].contacts = 1;
    scene.guide[0].contact[0] = {0, 0};
    scene.gravity.y = -weight;
    scene.body[0].v[0] = 1;
    const Stepper stepper(scene);
    EXPECT_EQ(stepper.source.tables.length, 1.0);
    State state = at_rest(stepper, before, 0);
    state.mode[0] = 1;
    EXPECT_EQ(stepper.step(state, dt).status, Status::ok);
    return int{state.sign[0]};
  };
  for (const signed char before : both) {
    EXPECT_EQ(sign_of(1.125 * rounding, before), 1);
    EXPECT_EQ(sign_of(-1.125 * rounding, before), -1);
    EXPECT_EQ(sign_of(0.125 * rounding, before), before);
    EXPECT_EQ(sign_of(-0.125 * rounding, before), before);
  }
}

// --- where rest and motion are both possible -------------------------------------------------------------------------

/// The elliptic trammel at rest of scenes/trammel_at_rest.toml, and before it a block that slides on a guide of its
/// own.
using TrammelSize = slideway::Size<2, 6, 3, 3, 2, 0, 0, 0, 2, 0>;

Scene<TrammelSize> trammel(double torque, double mu_level, double mu_upright, double force) {
  Scene<TrammelSize> scene;
  scene.bodies = 2;
  scene.guides = 3;
  scene.loads = 1;
  for (int i = 0; i < 2; ++i) {
    scene.body[i].joint = Joint::planar;
    scene.body[i].mass = 1;
    scene.body[i].inertia = 1.0 / 3;
  }
  scene.body[0].v[0] = 1;
  scene.body[1].q[0] = 0.96;
  scene.body[1].q[1] = 0.28;
  scene.guide[1].slider = scene.guide[2].slider = 1;
  scene.guide[1].contact[0] = {0.96, -0.28};
  scene.guide[2].contact[0] = {-0.96, 0.28};
  scene.guide[2].direction = scene.guide[2].tangent = {0, 1};
  scene.guide[0].mu = scene.guide[0].mu_static = 0.5;
  scene.guide[1].mu = scene.guide[1].mu_static = mu_level;
  scene.guide[2].mu = scene.guide[2].mu_static = mu_upright;
  scene.load[0].body = 1;
  scene.load[0].force = {force, force};
  scene.load[0].torque = torque;
  return scene;
}

TEST(ARefusal, NamesTheFirstGuideOfThoseItIsAbout) {
  const slideway::RunTimeStepper<TrammelSize> stepper(trammel(9, 0.5, 0.5, 6));
  slideway::RunTimeStepper<TrammelSize>::Reaction r{};
  const Report report = stepper.reaction(stepper.start(), {}, r);
  EXPECT_EQ(report.status, Status::not_unique);
  EXPECT_EQ(report.guide, 1);
}

TEST(ARefusal, NamesTheFirstGuideWhereNoSingleOneIsToBlame) {
  // Two overhung sliders (docs/theory.md) that know nothing of each other, each without a solution.
  Scene<BlockSize> scene;
  scene.gravity = {0, -10};
  scene.bodies = scene.guides = scene.loads = 2;
  for (int i = 0; i < 2; ++i) {
    scene.body[i].joint = Joint::planar;
    scene.body[i].mass = 1;
    scene.body[i].inertia = 0.01;
    scene.body[i].com = {0, 0.3};
    scene.body[i].v[0] = 1;
    scene.guide[i].slider = scene.load[i].body = i;
    scene.guide[i].contacts = 2;
    scene.guide[i].contact[0] = {-0.05, 0};
    scene.guide[i].contact[1] = {0.05, 0};
    scene.guide[i].mu = scene.guide[i].mu_static = 0.2;
    scene.load[i].torque = 0.05;
  }
  const auto blamed = [&] {
    const Stepper stepper(scene);
    Reaction r{};
    const Report report = stepper.reaction(stepper.start(), {}, r);
    EXPECT_EQ(report.status, Status::no_solution);
    return report.guide;
  };
  EXPECT_EQ(blamed(), 0);
  for (const int sound : {0, 1}) {  // one alone is
    const double torque = scene.load[sound].torque;
    scene.load[sound].torque = 0;
    scene.guide[sound].mu = scene.guide[sound].mu_static = 0.1;
    EXPECT_EQ(blamed(), 1 - sound);
    scene.load[sound].torque = torque;
    scene.guide[sound].mu = scene.guide[sound].mu_static = 0.2;
  }
}

TEST(GuidesThatLockEachOther, KeepTheFacesThatTheyHad) {
  // With p the force on the upright guide, and next to no load: friction p on the level one, which carries -7/24 p, and
  // so does the upright's friction. Any p will do where mu is above 24/7 on the level guide and 7/24 on the upright
  // one.
  slideway::RunTimeStepper<TrammelSize> stepper(trammel(0.125, 4, 0.5, 0));
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  for (const signed char sign : both) {
    auto state = stepper.start();
    state.decided = true;
    state.mode[0] = 1;
    state.sign[0] = 1;
    state.sign[1] = static_cast<signed char>(-sign);
    state.sign[2] = sign;
    slideway::RunTimeStepper<TrammelSize>::Reaction r{};
    const Report report = stepper.reaction(state, {}, r);
    ASSERT_EQ(report.status, Status::ok) << sentence(report.status);
    EXPECT_NEAR(r.acceleration[3], 0, exact);
    EXPECT_GE(r.lambda[2] * sign, 0);
    EXPECT_LE(r.lambda[1] * sign, 0);
    EXPECT_GT(std::fabs(r.lambda[2]) + std::fabs(r.lambda[1]), 0.01);
  }
}

}  // namespace
