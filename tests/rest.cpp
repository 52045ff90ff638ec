// Guides at rest: what holds, what breaks away and whither, and which stiction forces are handed out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <support/litter.hpp>
#include <support/steppers.hpp>

namespace {

using namespace slideway;
using namespace slideway::test;

constexpr double dt = 1e-3;

RunStepper::Reaction reaction_of(const RunStepper& stepper, const RunState& state, Report& report) {
  RunStepper::Reaction r{};
  report = stepper.reaction(state, {}, r);
  return r;
}

RunStepper::Reaction reaction_at_start(const RunStepper& stepper) {
  Report report;
  const auto r = reaction_of(stepper, stepper.start(), report);
  EXPECT_EQ(report.status, Status::ok) << sentence(report.status);
  return r;
}

// --- one guide -------------------------------------------------------------------------------------------------------

TEST(Block, StopsWhenAndWhereItIsKnownToStop) {
  // t = v0 / (mu g), x = v0^2 / (2 mu g), with mu = 0.2, g = 9.81.
  const double t = 0.50968399592252803262, x = 0.25484199796126401631;
  for (const Method method : located) {
    const RunStepper stepper = stepper_of("block_on_plane", method);
    const History r = run(stepper, stepper.start(), dt, 1000);
    ASSERT_EQ(r.last.status, Status::ok);
    ASSERT_EQ(r.events.size(), 1u);
    EXPECT_EQ(r.events[0].kind, EventKind::stick);
    EXPECT_NEAR(r.events[0].t, t, 1e-12);
    EXPECT_NEAR(r.state.q[0], x, 1e-12);
    EXPECT_EQ(r.state.mode[0], 0);
    RecordProperty(std::string(name(method)) + "_t", std::to_string(std::fabs(r.events[0].t - t) * 1e15) + "e-15");
    RecordProperty(std::string(name(method)) + "_x", std::to_string(std::fabs(r.state.q[0] - x) * 1e15) + "e-15");
  }
}

TEST(Block, PushedWithHalfOfWhatFrictionHoldsDoesNotMoveOnceAtRest) {
  // 5 N against a limit of 10 N for 10 s, from rest and from sliding either way.
  for (const Method method : integrating) {
    double most = 0;
    for (const char* v : {"[0, 0, 0]", "[1, 0, 0]", "[-1, 0, 0]"}) {
      const RunStepper stepper = stepper_of("pushed_block", method, {std::string("body.block.v=") + v});
      RunState state = stepper.start();
      double at_rest = 0;
      bool rests = false;
      for (int k = 0; k < 10000; ++k) {
        ASSERT_EQ(stepper.step(state, dt).status, Status::ok);
        if (!rests && state.mode[0] == 0) {
          rests = true;
          at_rest = state.q[0];
        }
        if (rests) most = std::fmax(most, std::fabs(state.q[0] - at_rest));
      }
      EXPECT_TRUE(rests) << name(method) << " " << v;
    }
    EXPECT_LT(most, 1e-13) << name(method);
    RecordProperty(std::string(name(method)), std::to_string(most * 1e15) + "e-15 m");
  }
}

TEST(Block, RestsByTheSameBitsWithAFrictionlessOneBesideIt) {
  Scene<Room> pile = scene_of("pushed_block");  // with a second block on it: the lower guide does not reach that
  pile.bodies = pile.guides = 2;
  pile.body[1] = pile.body[0];
  pile.body[1].q[1] = 0.2;
  pile.guide[1] = pile.guide[0];
  pile.guide[1].slider = 1;
  pile.guide[1].rail = 0;
  pile.guide[1].origin = {0, 0.2};
  Scene<Room> both = pile;
  both.bodies = both.guides = 3;
  both.body[2] = pile.body[0];
  both.guide[2] = pile.guide[0];
  both.guide[2].slider = 2;
  both.guide[2].mu = both.guide[2].mu_static = 0;
  const auto r = reaction_at_start(RunStepper(pile));
  litter_stack();  // parts without ideal rows use none of what those with some do
  const auto beside = reaction_at_start(RunStepper(both));
  for (int c = 0; c < 4; ++c) EXPECT_EQ(beside.lambda[c], r.lambda[c]);
  for (int g = 0; g < 2; ++g) EXPECT_EQ(beside.friction[g], r.friction[g]);
  for (int j = 0; j < 6; ++j) EXPECT_EQ(beside.acceleration[j], r.acceleration[j]);
}

TEST(Block, BreaksAwayByMuStaticAndSlidesByMu) {
  // mu = 0.5, N = 20 N: 10 N. The push stands beside the weight's line, but Lambda = 20 N whatever the feet share.
  const std::vector<std::string> sticky = {"guide.way.mu_static=0.6", "load.push.force=[11, 0]"};
  const auto held = reaction_at_start(stepper_of("pushed_block", Method::rk4, sticky));
  EXPECT_NEAR(held.friction[0], -11, 1e-12);
  EXPECT_NEAR(held.acceleration[0], 0, 1e-13);
  std::vector<std::string> pushed = {"guide.way.mu_static=0.6", "load.push.force=[13, 0]"};
  for (const double direction : {1.0, -1.0}) {
    pushed[1] = direction > 0 ? "load.push.force=[13, 0]" : "load.push.force=[-13, 0]";
    const auto slips = reaction_at_start(stepper_of("pushed_block", Method::rk4, pushed));
    EXPECT_NEAR(slips.friction[0], -10 * direction, 1e-12);      // mu, not mu_static, at the very onset
    EXPECT_NEAR(slips.acceleration[0], 1.5 * direction, 1e-12);  // (13 - 10) / 2
  }
}

TEST(Block, AtItsLimitExactlyRests) {
  for (const Method method : integrating) {
    const RunStepper stepper = stepper_of("pushed_block", method, {"load.push.force=[10, 0]"});
    const History r = run(stepper, stepper.start(), dt, 100);
    EXPECT_EQ(r.last.status, Status::ok) << name(method);
    EXPECT_EQ(r.state.mode[0], 0) << name(method);
    EXPECT_LT(std::fabs(r.state.q[0]), 1e-13) << name(method);
  }
}

TEST(Block, WithoutLoadIsAtRestAndStartsBySmallForces) {
  // Contact forces that vanish: the limit is zero, and any push moves it.
  const std::vector<std::string> weightless = {"gravity=[0, 0]", "load.push.force=[0, 0]"};
  for (const Method method : integrating) {
    const RunStepper stepper = stepper_of("pushed_block", method, weightless);
    History r = run(stepper, stepper.start(), dt, 10);
    EXPECT_EQ(r.last.status, Status::ok) << name(method) << ": " << sentence(r.last.status);
    EXPECT_EQ(r.state.q[0], 0);
    const RunStepper sliding =
        stepper_of("pushed_block", method, {"gravity=[0, 0]", "load.push.force=[0, 0]", "body.block.v=[1, 0, 0]"});
    r = run(sliding, sliding.start(), dt, 10);
    EXPECT_EQ(r.last.status, Status::ok) << name(method) << ": " << sentence(r.last.status);
    EXPECT_NEAR(r.state.q[0], 0.01, 1e-15) << name(method);
  }
}

TEST(Block, PreloadHoldsAndBrakesIt) {
  // 4 N of preload, no weight: 3 N do not move it, 5 N do, by (5 - 4) / 2.
  std::vector<std::string> settings = {"gravity=[0, 0]", "guide.way.preload=4", "guide.way.mu=0",
                                       "guide.way.mu_static=0", "load.push.force=[3, 0]"};
  auto r = reaction_at_start(stepper_of("pushed_block", Method::rk4, settings));
  EXPECT_NEAR(r.friction[0], -3, 1e-14);
  settings.back() = "load.push.force=[5, 0]";
  r = reaction_at_start(stepper_of("pushed_block", Method::rk4, settings));
  EXPECT_NEAR(r.friction[0], -4, 1e-14);
  EXPECT_NEAR(r.acceleration[0], 0.5, 1e-14);
  settings.back() = "load.push.force=[0, 0]";
  settings.push_back("body.block.v=[1, 0, 0]");  // stops after 1 / 2 s, 1/4 m
  for (const Method method : located) {
    const RunStepper stepper = stepper_of("pushed_block", method, settings);
    const History stopped = run(stepper, stepper.start(), dt, 1000);
    ASSERT_EQ(stopped.events.size(), 1u);
    EXPECT_NEAR(stopped.events[0].t, 0.5, 1e-12);
    EXPECT_NEAR(stopped.state.q[0], 0.25, 1e-12);
    EXPECT_NEAR(stopped.energy.dissipated, 1, 1e-12);
  }
}

TEST(Block, ViscousFrictionSlowsItExponentially) {
  // v = exp(-c t / m), c = 3 N s/m, m = 2 kg.
  const RunStepper stepper = stepper_of("pushed_block", Method::dop853_located,
                                        {"guide.way.mu=0", "guide.way.mu_static=0", "guide.way.viscous=3",
                                         "load.push.force=[0, 0]", "body.block.v=[1, 0, 0]"});
  const History r = run(stepper, stepper.start(), 0.01, 100);
  ASSERT_EQ(r.last.status, Status::ok);
  EXPECT_NEAR(r.state.v[0], std::exp(-1.5), 1e-14);
  EXPECT_NEAR(r.state.q[0], (1 - std::exp(-1.5)) / 1.5, 1e-14);
  EXPECT_NEAR(r.energy.dissipated, 1 - std::exp(-3), 1e-13);
}

TEST(Block, CannotBeMadeWithMuStaticBelowMuOrNegative) {
  Scene<Room> scene = scene_of("pushed_block");
  scene.guide[0].mu_static = 0.4;
  RunState state = RunStepper(scene).start();
  EXPECT_EQ(RunStepper(scene).step(state, dt).status, Status::invalid_input);
  scene.guide[0].mu = scene.guide[0].mu_static = -0.1;
  EXPECT_EQ(RunStepper(scene).step(state, dt).status, Status::invalid_input);
}

TEST(Belt, KeepsItsPeriodForTwenty) {
  // docs: stick 2 (mu_static - mu) m g / (k v), slip by the phase of the oscillation; x between the two extremes.
  const double slip = 2.6184222465698971961, stick = 4.905, low = 0.23525979450721326455, high = 0.74574020549278673545;
  for (const Method method : located) {
    const RunStepper stepper = stepper_of("belt", method);
    RunState state = stepper.start();
    std::vector<Event> events;
    double least = 1, most = 0;
    while (events.size() < 42) {
      const RunState before = state;
      const Report report = stepper.step(state, dt);
      ASSERT_EQ(report.status, Status::ok);
      events.insert(events.end(), report.event, report.event + report.events);
      // Extremes are where the speed vanishes: by the parabola that the step's end shows.
      if (before.v[1] * state.v[1] <= 0 && state.v[1] != before.v[1]) {
        const double a = (state.v[1] - before.v[1]) / dt, x = state.q[1] - state.v[1] * state.v[1] / (2 * a);
        least = std::fmin(least, x);
        most = std::fmax(most, x);
      }
    }
    double worst = 0;
    for (std::size_t k = 2; k < events.size(); ++k) {
      EXPECT_EQ(events[k].kind, k % 2 == 0 ? EventKind::slip : EventKind::stick) << k;
      const double phase = events[k].t - events[k - 1].t;
      worst = std::fmax(worst, std::fabs(phase - (k % 2 == 0 ? stick : slip)));
    }
    EXPECT_LT(worst, 1e-9) << name(method);
    EXPECT_NEAR(least, low, 1e-9) << name(method);
    EXPECT_NEAR(most, high, 1e-9) << name(method);
    RecordProperty(std::string(name(method)) + "_phase", std::to_string(worst * 1e12) + "e-12 s");
  }
}

TEST(DwellingGuide, HasTheLeastFriction) {
  // The ram's drive stands still: friction at its guide is a choice, and none is the least.
  const RunStepper stepper = stepper_of("gantry", Method::rk4, {"drive.down.amplitude=0.0"});
  Report report;
  const auto r = reaction_of(stepper, stepper.start(), report);
  ASSERT_EQ(report.status, Status::ok);
  EXPECT_EQ(report.uniqueness, Uniqueness::motion_only);
  EXPECT_NEAR(r.friction[1], 0, 1e-10);
  for (const Method method : {Method::euler, Method::rk4, Method::rk4_located, Method::kinematic}) {
    RunStepper moving = stepper_of("gantry", method, {"drive.down.amplitude=0.0"});
    const History made = run(moving, moving.start(), dt, 100);
    EXPECT_EQ(made.last.status, Status::ok) << name(method) << ": " << sentence(made.last.status);
  }
}

// --- more guides at rest than freedom --------------------------------------------------------------------------------

TEST(TrammelAtRest, StaysForAHundredSeconds) {
  for (const Method method : integrating) {
    const RunStepper stepper = stepper_of("trammel_at_rest", method);
    const RunState start = stepper.start();
    const History r = run(stepper, start, 0.01, 10000);
    ASSERT_EQ(r.last.status, Status::ok) << name(method);
    EXPECT_EQ(r.uniqueness, Uniqueness::motion_only);
    double moved = 0;
    for (int j = 0; j < 3; ++j) moved = std::fmax(moved, std::fabs(r.state.q[j] - start.q[j]));
    EXPECT_LT(moved, 1e-12) << name(method);
    RecordProperty(std::string(name(method)), std::to_string(moved * 1e15) + "e-15 m");
  }
}

TEST(TrammelAtRest, HasTheStictionOfLeastNorm) {
  // scenes/trammel_at_rest.toml: with p = lambda_upright in [17/5, 389/41], F_level = p - 6, F_upright = (7 p - 43)
  // / 24. (p - 6)^2 + (7 p - 43)^2 / 576 is least at p = 3757 / 625.
  const auto r = reaction_at_start(stepper_of("trammel_at_rest", Method::rk4));
  const double p = 3757.0 / 625;
  EXPECT_NEAR(r.lambda[1], p, 1e-13);
  EXPECT_NEAR(r.lambda[0], -(101 + 7 * p) / 24, 1e-13);
  EXPECT_NEAR(r.friction[0], p - 6, 1e-13);
  EXPECT_NEAR(r.friction[1], (7 * p - 43) / 24, 1e-13);
}

TEST(TrammelAtRest, HasForcesOnTheBorderOfWhatIsAllowedWhereTheShortestAreNot) {
  // It holds down to -3.504 N m; just before, few sets of forces do, away from the shortest. One limit is reached.
  for (const char* torque : {"-3.5", "-3.503", "-3.50399"}) {
    const RunStepper stepper = stepper_of("trammel_at_rest", Method::rk4, {std::string("load.push.torque=") + torque});
    const auto r = reaction_at_start(stepper);
    double nearest = 1;
    for (int g = 0; g < 2; ++g) {
      const double left = 0.5 * std::fabs(r.lambda[g]) - std::fabs(r.friction[g]);
      EXPECT_GT(left, -1e-12) << torque;
      nearest = std::fmin(nearest, left);
    }
    EXPECT_LT(nearest, 1e-9) << torque;
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(r.acceleration[j], 0, 1e-12);
  }
}

TEST(TrammelAtRest, MovesWhereNothingHoldsIt) {
  for (const auto& [torque, angle] : {std::pair("13", 4.284452297), std::pair("-4", 0.0)}) {
    const RunStepper stepper = stepper_of("trammel_at_rest", Method::rk4, {std::string("load.push.torque=") + torque});
    const auto r = reaction_at_start(stepper);
    if (angle != 0) {
      EXPECT_NEAR(r.acceleration[2], angle, 1e-9);
      EXPECT_NEAR(r.lambda[0], -10.283863368669, 1e-11);
      EXPECT_NEAR(r.lambda[1], -0.341578327444, 1e-11);
    } else {
      EXPECT_NEAR(r.lambda[0], -1.932342857143, 1e-11);
      EXPECT_NEAR(r.lambda[1], 7.114971428571, 1e-11);
    }
  }
}

TEST(TrammelAtRest, IsRefusedWhereRestAndMotionAreBothPossible) {
  RunStepper stepper = stepper_of("trammel_at_rest", Method::rk4_located, {"load.push.torque=9"});
  RunState state = stepper.start();
  const Report refused = stepper.step(state, dt);
  EXPECT_EQ(refused.status, Status::not_unique);
  EXPECT_EQ(refused.uniqueness, Uniqueness::refuted);
  EXPECT_EQ(refused.guide, 0);
  EXPECT_TRUE(state == stepper.start());
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  const Report held = stepper.step(state, dt);
  EXPECT_EQ(held.status, Status::ok);
  EXPECT_EQ(held.uniqueness, Uniqueness::refuted);
  EXPECT_EQ(held.guide, 0);
  EXPECT_EQ(state.mode[0], 0);
  EXPECT_EQ(state.mode[1], 0);
}

TEST(TrammelAtRest, HasForcesThatAreContinuousWhileTheFacesStay) {
  double last = 0;
  for (int k = 0; k <= 400; ++k) {
    const double torque = -3 + 11.3 * k / 400;  // to where one limit is reached, and along it
    Scene<Room> scene = scene_of("trammel_at_rest");
    scene.load[0].torque = torque;
    const auto r = reaction_at_start(RunStepper(scene));
    if (k > 0) {
      EXPECT_LT(std::fabs(r.friction[0] - last), 0.5) << torque;
    }
    last = r.friction[0];
  }
}

}  // namespace
