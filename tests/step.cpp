// The contracts of Stepper: every refusal leaves the state alone, time is a product, a copy replays, the guesses do not
// matter, live inputs and laws are what they say, and projection is the least change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <slideway/io/stepper.hpp>
#include <string>
#include <vector>

// Doubles are promoted on purpose: what is compared with is computed in long double.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

namespace {

using slideway::Drive;
using slideway::Input;
using slideway::Law;
using slideway::Method;
using slideway::none;
using slideway::Report;
using slideway::Status;
using slideway::io::RunSize;
using Scene = slideway::Scene<RunSize>;
using Stepper = slideway::RunTimeStepper<RunSize>;
using State = Stepper::State;
using Inputs = Stepper::Inputs;
using Reaction = Stepper::Reaction;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A shipped scene with settings PATH=VALUE.
Scene shipped(const std::string& name, const std::vector<std::string>& settings = {}) {
  const auto reading = slideway::io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml", settings);
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene ? reading.scene->scene : Scene{};
}

bool same_bytes(const State& a, const State& b) { return std::memcmp(&a, &b, sizeof(State)) == 0; }

/// A copy to the last byte, padding included, which plain assignment need not copy.
State bytes_of(const State& state) {
  State copy;
  std::memcpy(&copy, &state, sizeof(State));
  return copy;
}

/// The step is refused with this status and the state is as it was, to the byte.
Report expect_refusal(const Stepper& stepper, State state, Status status, double dt = 1e-3, const Inputs& inputs = {}) {
  const State before = bytes_of(state);
  const Report report = stepper.step(state, dt, inputs);
  EXPECT_EQ(report.status, status) << name(report.status);
  EXPECT_TRUE(same_bytes(before, state));
  return report;
}

State started(const Stepper& stepper, int steps = 10, double dt = 1e-3) {
  State state = stepper.start();
  for (int k = 0; k < steps; ++k) EXPECT_EQ(stepper.step(state, dt).status, Status::ok);
  return state;
}

// --- refusals --------------------------------------------------------------------------------------------------------

TEST(Events, AReversalInTheFirstStepIsCountedWhereThereIsFriction) {
  Scene scene = shipped("overhung_slider");
  scene.body[0].v[0] = 5e-4;  // stops after half a step
  Stepper rough(scene);
  State state = rough.start();
  EXPECT_GE(rough.step(state, 1e-3).unlocated_events, 1);
  scene.guide[0].mu = scene.guide[0].mu_static = 0;
  scene.body[0].v[0] = -1e-3;
  scene.gravity = {5, -10};  // back and forth, smoothly
  const Stepper smooth(scene);
  state = smooth.start();
  for (int k = 0; k < 5; ++k) EXPECT_EQ(smooth.step(state, 1e-3).unlocated_events, 0);
  EXPECT_GT(state.v[0], 0);
}

TEST(StepRefuses, DtThatIsNotPositiveAndFinite) {
  for (const Method method : {Method::euler, Method::rk4, Method::kinematic}) {
    Stepper stepper(shipped("crank_rocker"));
    stepper.method = method;
    const State state = started(stepper);
    for (const double dt : {0.0, -0.0, -1e-3, infinity, -infinity, nan}) {
      expect_refusal(stepper, state, Status::invalid_input, dt);
    }
  }
}

TEST(StepRefuses, ScenesWithDefects) {
  Scene scene = shipped("crank_rocker");
  scene.body[1].parent = 7;            // no such body
  scene.guides = RunSize::guides + 1;  // more than there is room for
  const Stepper stepper(scene);
  expect_refusal(stepper, stepper.start(), Status::invalid_input);
  Reaction reaction;
  EXPECT_EQ(stepper.reaction(stepper.start(), {}, reaction).status, Status::invalid_input);
  State state = stepper.start();
  EXPECT_EQ(stepper.project(state).status, Status::invalid_input);
  EXPECT_EQ(stepper.kinetic_energy(state), 0);
}

/// A body on a revolute joint at (0, 1) m, both contacts of its guide on a line of the ground: one coordinate, two
/// rows.
Scene twice_held(double angle, double rate) {
  Scene scene;
  scene.gravity = {0, -9.81};
  scene.bodies = scene.guides = 1;
  scene.body[0].at = {0, 1};
  scene.body[0].mass = 1;
  scene.body[0].com = {0.3, 0};
  scene.body[0].inertia = 0.1;
  scene.body[0].q[0] = angle;
  scene.body[0].v[0] = rate;
  scene.guide[0].slider = 0;
  scene.guide[0].contacts = 2;
  scene.guide[0].contact[0] = {0.2, 0};
  scene.guide[0].contact[1] = {0.7, 0.1};
  scene.guide[0].mu = scene.guide[0].mu_static = 0.2;
  return scene;
}

TEST(StepRefuses, ContactsOnASliderThatCannotTurnInEveryPose) {
  for (int k = 0; k < 500; ++k) {
    Stepper stepper(twice_held(0.0123 * k, 0.5 + 1e-3 * k));
    stepper.drift_limit = 1e9;  // the poses are off the line: rank is what is asked
    Reaction reaction;
    EXPECT_NE(stepper.reaction(stepper.start(), {}, reaction).status, Status::ok) << k;
  }
}

TEST(StepRefuses, AnInputThatIsNotANumberWhereOnlyADriveFeelsIt) {
  Scene scene;
  scene.bodies = scene.drives = scene.loads = scene.inputs = 1;
  scene.body[0].mass = 1;
  scene.body[0].inertia = 1;
  scene.body[0].v[0] = 1;
  scene.drive[0].c[1] = 1;
  scene.load[0].torque = 1;
  scene.load[0].input = 0;
  Inputs inputs;
  inputs.input[0].value = nan;
  for (const Method method : {Method::euler, Method::rk4, Method::kinematic}) {
    Stepper stepper(scene);
    stepper.method = method;
    expect_refusal(stepper, stepper.start(), Status::invalid_input, 1e-3, inputs);
  }
}

TEST(StepRefuses, StatesThatAreNotFinite) {
  for (const char* scene : {"crank_rocker", "crank_rocker_free", "four_bar_chain"}) {
    for (const Method method : {Method::euler, Method::rk4}) {
      Stepper stepper(shipped(scene));
      stepper.method = method;
      const State good = started(stepper);
      Reaction reaction;
      for (const double bad : {infinity, -infinity, nan}) {
        std::vector<State> states;
        for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
          states.push_back(good);
          states.back().q[j] = bad;
          states.push_back(good);
          states.back().v[j] = bad;
        }
        states.push_back(good);
        states.back().start = bad;
        for (State& state : states) {
          expect_refusal(stepper, state, Status::invalid_input);
          EXPECT_EQ(stepper.reaction(state, {}, reaction).status, Status::invalid_input);
          EXPECT_EQ(stepper.project(state).status, Status::invalid_input);
        }
      }
    }
  }
}

TEST(StepRefuses, InputsThatAreNotFinite) {
  Scene driven = shipped("crank_rocker"), loaded = shipped("crank_rocker_free");
  driven.inputs = loaded.inputs = 1;
  driven.drive[0].law = Law::input;
  driven.drive[0].input = 0;
  loaded.loads = 1;
  loaded.load[0].torque = 1;
  loaded.load[0].input = 0;
  for (const Scene& scene : {driven, loaded}) {
    for (const Method method : {Method::euler, Method::rk4}) {
      Stepper stepper(scene);
      stepper.method = method;
      Inputs inputs;
      inputs.input[0] = {0, 3, 0};
      State good = stepper.start();
      ASSERT_EQ(stepper.step(good, 1e-3, inputs).status, Status::ok);
      for (const double bad : {infinity, -infinity, nan}) {
        for (const Input input : {Input{bad, 3, 0}, Input{0.003, bad, 0}, Input{0.003, 3, bad}}) {
          inputs.input[0] = input;
          expect_refusal(stepper, good, Status::invalid_input, 1e-3, inputs);
        }
      }
    }
  }
}

TEST(StepTakes, AGuideToBeAtRestToRounding) {
  // A bar turns about the point that it has on the guide: its frame's speed and its turning cancel there, to 1e-16 m/s.
  // In two parts, so that the two are summed in another order than here.
  int rounded = 0;
  for (int k = 0; k < 100; ++k) {
    Scene scene;
    scene.bodies = 2;
    scene.guides = 1;
    scene.body[0].joint = slideway::Joint::planar;
    scene.body[0].mass = scene.body[0].inertia = 1;
    scene.body[1].parent = 0;
    scene.body[1].joint = slideway::Joint::fixed;
    scene.body[1].at = {0.3, -0.4};
    scene.guide[0].slider = 1;
    scene.guide[0].contact[0] = {0.4, -0.6};
    scene.guide[0].mu = scene.guide[0].mu_static = 0.2;
    const double angle = 0.01 * k, omega = 0.3;
    const double x = 0.7 * std::cos(angle) + std::sin(angle), y = 0.7 * std::sin(angle) - std::cos(angle);
    const double q[3] = {0, -y, angle}, v[3] = {omega * y, -omega * x, omega};
    std::copy(q, q + 3, scene.body[0].q);
    std::copy(v, v + 3, scene.body[0].v);
    Scene sticky = scene;
    sticky.guide[0].preload = 100;  // N: whatever is at rest stays there
    State state = Stepper(sticky).start();
    ASSERT_EQ(Stepper(sticky).step(state, 1e-9).status, Status::ok) << k;
    EXPECT_EQ(state.mode[0], 0) << k;
    const Stepper stepper(scene);
    state = stepper.start();
    state.v[0] += 1e-13;  // m/s: slow, but sliding; for a tenth of a nanosecond nothing stops it
    ASSERT_EQ(stepper.step(state, 1e-10).status, Status::ok) << k;
    EXPECT_NE(state.mode[0], 0) << k;
    slideway::Kinematics<RunSize> kinematics;
    const double none_prescribed[3] = {};
    slideway::kinematics(stepper.source, q, v, none_prescribed, kinematics);
    slideway::Sliding sliding;
    slideway::sliding(stepper.source, kinematics, 0, sliding);
    rounded += sliding.slip[0] != 0 ? 1 : 0;
  }
  EXPECT_GT(rounded, 10);  // of 100; else the test is about zeros only
}

TEST(StepTakes, AGuideWhoseSliderCanOnlyMoveAcrossItToDwell) {
  // A slide at 0.3 rad on a turning arm, and a guide across it: the slip is zero whatever moves, but for a rounding
  // error of the rotations, whose sign must not become a direction of friction.
  for (int k = 0; k < 100; ++k) {
    Scene scene;
    scene.gravity = {0, -9.81};
    scene.bodies = 2;
    for (int i = 0; i < 2; ++i) scene.body[i].mass = scene.body[i].inertia = scene.body[i].v[0] = 1;
    scene.body[0].q[0] = 0.7 + 0.01 * k;
    scene.body[1].parent = 0;
    scene.body[1].joint = slideway::Joint::prismatic;
    scene.body[1].at = scene.guide[0].origin = {1, 0};
    scene.body[1].angle = 0.3;
    scene.body[1].turn = {std::cos(0.3), std::sin(0.3)};
    scene.guides = 1;
    scene.guide[0].slider = 1;
    scene.guide[0].rail = 0;
    scene.guide[0].direction = scene.guide[0].tangent = {-std::sin(0.3), std::cos(0.3)};
    scene.guide[0].mu = scene.guide[0].mu_static = 0.3;
    ASSERT_EQ(defects(scene).count, 0);
    const Stepper stepper(scene);
    State state = stepper.start();
    const Report report = stepper.step(state, 1e-3);
    EXPECT_EQ(report.status, Status::ok) << k << name(report.status);
    EXPECT_EQ(state.mode[0], 0) << k;
    EXPECT_EQ(report.uniqueness, slideway::Uniqueness::motion_only) << k;
    if (HasFailure()) return;  // one is enough
  }
}

TEST(StepRefuses, KinematicWhereTheDrivesDoNotDecideTheMotion) {
  for (const char* free : {"crank_rocker_free", "slider_crank", "elliptic_trammel", "four_bar_chain", "squeezer"}) {
    Stepper stepper(shipped(free));
    stepper.method = Method::kinematic;
    expect_refusal(stepper, stepper.start(), Status::invalid_input);
  }
}

TEST(StepRefuses, ConstraintsThatLoseRank) {
  // Level parallelograms: the couplers' pins no longer hold the rockers apart.
  const Stepper chain(shipped("four_bar_chain"));
  State level = chain.start();
  for (int j = 0; j < 9; ++j) level.q[j] = 0;
  expect_refusal(chain, level, Status::singular_constraints);
  EXPECT_EQ(chain.project(level).status, Status::singular_constraints);

  // Two contacts in one place, with friction and without.
  for (const char* mu : {"guide.way.mu=0.1", "guide.way.mu=0.0"}) {
    Scene twins = shipped("overhung_slider", {mu});
    twins.guide[0].contact[1] = twins.guide[0].contact[0];
    const Stepper redundant(twins);
    expect_refusal(redundant, redundant.start(), Status::singular_constraints);
  }

  // A free coordinate that moves no mass.
  Scene scene = shipped("overhung_slider");
  scene.body[0].inertia = scene.body[0].mass = 0;
  const Stepper massless(scene);
  expect_refusal(massless, massless.start(), Status::singular_constraints);
}

TEST(StepRefuses, ProblemsWithoutAndWithSeveralSolutions) {
  // docs/theory.md, overhung slider: mu c > a. No moment: no contact forces balance it; 0.5 N m: two pairs do.
  const Stepper never(shipped("overhung_slider", {"guide.way.mu=0.2", "load.load1.torque=0.0"}));
  expect_refusal(never, never.start(), Status::no_solution);
  const Stepper twice(shipped("overhung_slider", {"guide.way.mu=0.2"}));
  EXPECT_EQ(expect_refusal(twice, twice.start(), Status::not_unique).uniqueness, slideway::Uniqueness::refuted);
}

TEST(StepRefuses, ResultsThatOverflow) {
  // A double pendulum at 1e160 rad/s: centripetal accelerations are beyond all numbers. The input was in order.
  Scene scene;
  scene.bodies = 2;
  for (int i = 0; i < 2; ++i) scene.body[i].mass = scene.body[i].inertia = 1;
  scene.body[1].parent = 0;
  scene.body[1].at = scene.body[1].com = {1, 0};
  scene.body[1].q[0] = 1;
  scene.body[0].v[0] = 1e160;
  for (const Method method : {Method::euler, Method::rk4}) {
    Stepper stepper(scene);
    stepper.method = method;
    expect_refusal(stepper, stepper.start(), Status::inaccurate);
  }
}

TEST(StepRefuses, EnergiesThatOverflow) {
  // 1e100 N at 1e150 m/s for 1e60 s: place and speed are numbers, the work is none.
  Scene scene;
  scene.bodies = scene.loads = 1;
  scene.body[0].mass = 1;
  scene.body[0].joint = slideway::Joint::prismatic;
  scene.body[0].v[0] = 1e150;
  scene.load[0].body = 0;
  scene.load[0].force = {1e100, 0};
  for (const Method method : slideway::methods) {
    if (method == Method::kinematic) continue;
    Stepper stepper(scene);
    stepper.method = method;
    expect_refusal(stepper, stepper.start(), Status::inaccurate, 1e60);
  }
}

TEST(StepRefuses, DriftBeyondItsLimit) {
  for (const Method method : {Method::euler, Method::rk4, Method::kinematic}) {
    Stepper stepper(shipped("crank_rocker"));  // length of the scene: 1 m, limit 1e-3 m
    stepper.method = method;
    State state = stepper.start();
    const double lever = std::sqrt(1.25);  // m, from O1 to the slot's pin
    state.q[0] += 1.01e-3 / lever;
    const Report refused = expect_refusal(stepper, state, Status::drift_limit);
    EXPECT_NEAR(refused.drift_position, 1.01e-3, 1e-8);  // m; the arc against its chord: 1e-3 rad squared, and a half
    state.q[0] -= 0.02e-3 / lever;
    EXPECT_EQ(stepper.step(state, 1e-3).status, Status::ok);
    state.q[0] += 1e-5;  // a kinematic step has taken the drift away
    stepper.drift_limit = 1e-6;
    expect_refusal(stepper, state, Status::drift_limit);
  }
}

TEST(StepRefuses, PlacesThatCannotBeReached) {
  // A rod as long as half the crank turns with it, but its end cannot stay on the way.
  Scene scene = shipped("slider_crank_driven");
  scene.body[2].at = {0.0765, 0};
  Stepper stepper(scene);
  stepper.method = Method::kinematic;
  State state = stepper.start();
  EXPECT_EQ(stepper.project(state).status, Status::no_convergence);
  EXPECT_TRUE(state == stepper.start());
  scene.body[2].at = {0.12, 0};  // reaches at the start, not at a quarter of a turn
  Stepper reaching(scene);
  reaching.method = Method::kinematic;
  state = reaching.start();
  ASSERT_EQ(reaching.project(state).status, Status::ok);
  expect_refusal(reaching, state, Status::no_convergence, 0.1);
}

TEST(StepRefuses, AnHlcpThatTakesMoreSolvesThanAllowed) {
  // Eight contacts, of which the two of a piston always push alike: these first guesses are wrong.
  Stepper stepper(shipped("v_engine_4"));
  stepper.hlcp.max_solves = 1;
  State state = stepper.start();
  for (int c = 0; c < 8; ++c) state.sign[c] = c % 2 == 0 ? 1 : -1;
  expect_refusal(stepper, state, Status::solve_limit, 5e-5);
  stepper.hlcp.max_solves = 100;
  const Report report = stepper.step(state, 5e-5);
  EXPECT_EQ(report.status, Status::ok);
  EXPECT_GT(report.solves, 1);
  EXPECT_LE(report.solves, 100);
}

TEST(StepRefuses, InALaterStageAsInTheFirst) {
  // The feet carry 8 and 2 N with mu = 0.2; the input takes the moment away within the step, and from 0.1 N m on
  // nothing balances the block (docs/theory.md, overhung slider).
  Scene scene = shipped("overhung_slider", {"guide.way.mu=0.2"});
  scene.load[0].input = 0;
  scene.inputs = 1;
  Stepper stepper(scene);
  stepper.hlcp.not_unique = slideway::NotUnique::continue_along_signs;
  Inputs inputs;
  inputs.input[0] = {1, 0, 0};
  State state = stepper.start();
  EXPECT_EQ(stepper.step(state, 1e-3, inputs).status, Status::ok);
  inputs.input[0] = {1, -1000, 0};  // 0.5 N m, then 0 in the middle of the step
  expect_refusal(stepper, state, Status::no_solution, 1e-3, inputs);
  inputs.input[0] = {1, 0, 0};
  EXPECT_EQ(stepper.step(state, 1e-3, inputs).status, Status::ok);
}

// --- time ------------------------------------------------------------------------------------------------------------

TEST(StepTime, IsAProduct) {
  const Stepper stepper(shipped("crank_rocker"));
  State state = stepper.start();
  state.start = 0.25;
  // The drive is elsewhere at 0.25 s: bring the state there.
  ASSERT_EQ(stepper.project(state).status, Status::ok);
  const double dt = 1e-3;
  for (int k = 1; k <= 1000; ++k) {
    ASSERT_EQ(stepper.step(state, dt).status, Status::ok);
    ASSERT_EQ(state.time(), 0.25 + k * dt);  // to the bit: a sum of 1000 would be elsewhere
    ASSERT_EQ(state.steps, k);
  }
  // Another dt starts a new count where the last one ended.
  const double middle = state.time();
  for (int k = 1; k <= 100; ++k) {
    ASSERT_EQ(stepper.step(state, 0.7e-3).status, Status::ok);
    ASSERT_EQ(state.time(), middle + k * 0.7e-3);
  }
  EXPECT_EQ(state.start, middle);
  EXPECT_EQ(state.steps, 100);
  // The same dt again goes on with the count.
  ASSERT_EQ(stepper.step(state, 0.7e-3).status, Status::ok);
  EXPECT_EQ(state.steps, 101);
}

TEST(StepTime, IsTheOneThatDrivesFollow) {
  const Stepper stepper(shipped("crank_rocker"));
  State state = stepper.start();
  for (int k = 0; k < 500; ++k) ASSERT_EQ(stepper.step(state, k % 2 == 0 ? 1e-3 : 0.5e-3).status, Status::ok);
  // rad; the crank's speed is constant, so rk4 has no error there but rounding: 500 steps of one ulp of 1 rad.
  EXPECT_NEAR(state.q[1], 3 * state.time(), 1e-13);
}

// --- what does not matter --------------------------------------------------------------------------------------------

TEST(StepReplays, FromACopyBitForBit) {
  for (const char* scene : {"crank_rocker_offset", "elliptic_trammel", "gantry", "quick_return"}) {
    const double dt = 1e-4;
    for (const Method method : {Method::euler, Method::rk4}) {
      Stepper stepper(shipped(scene));
      stepper.method = method;
      State state = started(stepper, 50, dt);
      State copy = state;
      State twin;
      for (int k = 0; k < 50; ++k) {
        const Report a = stepper.step(state, dt);
        EXPECT_EQ(a.status, Status::ok);
        if (k == 24) twin = copy;
        const Report b = stepper.step(copy, dt);
        EXPECT_EQ(a.residual, b.residual);
        EXPECT_EQ(a.energy.dissipated, b.energy.dissipated);
      }
      Stepper another(shipped(scene));
      another.method = method;
      for (int k = 24; k < 50; ++k) another.step(twin, dt);
      EXPECT_TRUE(state == copy) << scene;
      EXPECT_TRUE(state == twin) << scene;
      EXPECT_EQ(std::memcmp(state.q, twin.q, sizeof state.q), 0);
      EXPECT_EQ(std::memcmp(state.v, twin.v, sizeof state.v), 0);
    }
  }
}

TEST(StepReplays, WhateverSignsAndModesItIsGivenAsGuesses) {
  for (const char* scene : {"crank_rocker", "crank_rocker_offset", "rod_on_two_guides", "gantry", "v_engine_4"}) {
    const Stepper stepper(shipped(scene));
    const double dt = 5e-5;
    State state = started(stepper, 5, dt);
    for (unsigned pattern = 0; pattern < 16; ++pattern) {
      State guess = state;
      for (int c = 0; c < stepper.source.tables.contacts; ++c) guess.sign[c] = (pattern >> (c % 4) & 1u) != 0 ? 1 : -1;
      for (int g = 0; g < stepper.source.scene.guides; ++g) guess.mode[g] = -state.mode[g];
      guess.decided = pattern % 3 == 0;  // else the modes are not even looked at
      State straight = state;
      Reaction one, other;
      ASSERT_EQ(stepper.reaction(guess, {}, one).status, Status::ok);
      ASSERT_EQ(stepper.reaction(straight, {}, other).status, Status::ok);
      for (int c = 0; c < stepper.source.tables.contacts; ++c) EXPECT_EQ(one.lambda[c], other.lambda[c]) << scene;
      for (int k = 0; k < 3; ++k) {
        const Report a = stepper.step(guess, dt), b = stepper.step(straight, dt);
        ASSERT_EQ(a.status, Status::ok);
        ASSERT_EQ(b.status, Status::ok);
        EXPECT_EQ(a.energy.work, b.energy.work);
        EXPECT_EQ(a.energy.dissipated, b.energy.dissipated);
        EXPECT_EQ(a.residual, b.residual);
      }
      EXPECT_TRUE(guess == straight) << scene;
      EXPECT_EQ(std::memcmp(guess.q, straight.q, sizeof guess.q), 0) << scene;
      EXPECT_EQ(std::memcmp(guess.v, straight.v, sizeof guess.v), 0) << scene;
    }
  }
}

TEST(StepEnergy, OfEulerIsItsPowerAtTheStart) {
  Scene scene;  // 2 kg at 3 m/s, pushed by 5 N against a damper of 1 N s/m: all numbers are exact
  scene.bodies = scene.loads = scene.joint_springs = 1;
  scene.body[0].mass = 2;
  scene.body[0].joint = slideway::Joint::prismatic;
  scene.body[0].v[0] = 3;
  scene.load[0].body = scene.joint_spring[0].body = 0;
  scene.load[0].force = {5, 0};
  scene.joint_spring[0].damping = 1;
  Stepper stepper(scene);
  stepper.method = Method::euler;
  State state = stepper.start();
  const Report report = stepper.step(state, 0.25);
  ASSERT_EQ(report.status, Status::ok);
  EXPECT_EQ(report.energy.work, 0.25 * 5 * 3);
  EXPECT_EQ(report.energy.dissipated, 0.25 * 3 * 3);
  EXPECT_EQ(report.energy.constraint_work, 0);
  EXPECT_EQ(state.v[0], 3 + 0.25 * (5 - 3) / 2);
}

// --- events ----------------------------------------------------------------------------------------------------------

TEST(StepCounts, ReversalsThatItGoesOver) {
  struct Row {
    const char* scene;
    int a_turn;
  };
  // At crank angles pi/2 and 3 pi/2 the slip reverses, and with it every contact's force.
  for (const Row row : {Row{"crank_rocker", 4}, {"crank_rocker_weightless", 4}, {"crank_rocker_two_contacts", 6}}) {
    for (const Method method : {Method::euler, Method::rk4, Method::kinematic}) {
      Stepper stepper(shipped(row.scene));
      stepper.method = method;
      State state = stepper.start();
      int events = 0, steps_with_events = 0;
      for (int k = 0; k < 2094; ++k) {  // 2 pi / 3 s
        const Report report = stepper.step(state, 1e-3);
        ASSERT_EQ(report.status, Status::ok);
        events += report.unlocated_events;
        steps_with_events += report.unlocated_events > 0 ? 1 : 0;
      }
      EXPECT_EQ(events, row.a_turn) << row.scene << " " << name(method);
      EXPECT_LE(steps_with_events, 4) << row.scene << " " << name(method);
    }
  }
  const Stepper smooth(shipped("rod_on_two_guides"));
  State state = smooth.start();
  for (int k = 0; k < 100; ++k) EXPECT_EQ(smooth.step(state, 1e-3).unlocated_events, 0);
}

// --- inputs ----------------------------------------------------------------------------------------------------------

TEST(StepInputs, ADriveThatFollowsAnInputDoesAsTheLawThatMadeIt) {
  // A polynomial of degree 2 is what an input is within a step.
  Scene scene = shipped("crank_rocker");
  scene.drive[0].law = Law::polynomial;
  scene.drive[0].terms = 3;
  scene.drive[0].c[0] = 0;
  scene.drive[0].c[1] = 3;
  scene.drive[0].c[2] = 0.5;
  const Stepper by_law(scene);
  scene.drive[0].law = Law::input;
  scene.drive[0].input = 0;
  scene.inputs = 1;
  const Stepper by_input(scene);
  const auto inputs_at = [](double t) {
    Inputs inputs;
    inputs.input[0] = {(0.5 * t + 3) * t, t + 3, 1};
    return inputs;
  };
  State a = by_law.start(), b = by_input.start();
  for (int k = 0; k < 1000; ++k) {
    const Report x = by_law.step(a, 1e-3), y = by_input.step(b, 1e-3, inputs_at(b.time()));
    ASSERT_EQ(x.status, Status::ok);
    ASSERT_EQ(y.status, Status::ok);
  }
  for (int j = 0; j < 2; ++j) {
    EXPECT_NEAR(a.q[j], b.q[j], 1e-13);  // rad; the two ways of writing the law differ by an ulp a step
    EXPECT_NEAR(a.v[j], b.v[j], 1e-12);
  }
  Reaction x, y;
  ASSERT_EQ(by_law.reaction(a, {}, x).status, Status::ok);
  ASSERT_EQ(by_input.reaction(b, inputs_at(b.time()), y).status, Status::ok);
  EXPECT_NEAR(x.drive[0], y.drive[0], 1e-10);  // N m
}

TEST(StepInputs, ALoadIsScaledByItsInputAllAlongTheStep) {
  // A mass of 2 kg on a straight joint, 3 N times (1 + 2 t - t^2 / 2): v = 1.5 (t + t^2 - t^3 / 6), a cubic that rk4
  // has without error. One step, so that only the input's course within it can tell.
  Scene scene;
  scene.bodies = 1;
  scene.body[0].joint = slideway::Joint::prismatic;
  scene.body[0].mass = 2;
  scene.loads = 1;
  scene.load[0].force = {3, 7};  // across the joint: of no effect
  scene.load[0].torque = 5;      // likewise
  scene.load[0].input = 0;
  scene.inputs = 1;
  ASSERT_EQ(defects(scene).count, 0);
  const Stepper stepper(scene);
  State state = stepper.start();
  Inputs inputs;
  inputs.input[0] = {1, 2, -1};
  const Report report = stepper.step(state, 0.5, inputs);
  ASSERT_EQ(report.status, Status::ok);
  const double t = 0.5, speed = 1.5 * (t + t * t - t * t * t / 6);
  EXPECT_NEAR(state.v[0], speed, 1e-15);                                                   // m/s, rounding
  EXPECT_NEAR(state.q[0], 1.5 * (t * t / 2 + t * t * t / 3 - t * t * t * t / 24), 1e-15);  // m
  // The load's work is the kinetic energy to the order of rk4's quadrature: v F is of degree 5 in t, h^5 / 2880 of it.
  EXPECT_NEAR(report.energy.work, speed * speed, 1e-4);  // J
}

// --- laws ------------------------------------------------------------------------------------------------------------

TEST(Drives, LawsAreTheirFormulasWithTheirDerivatives) {
  using Real = long double;
  const auto value = [](const Drive& drive, Real t) {
    const double* c = drive.c;
    if (drive.law == Law::uniform) return c[0] + c[1] * t;
    if (drive.law == Law::harmonic) return c[0] + c[1] * std::sin(c[2] * t + c[3]);
    Real sum = 0;
    for (int k = 0; k < drive.terms; ++k) sum += c[k] * std::pow(t, Real(k));
    return sum;
  };
  std::vector<Drive> drives(10);
  drives[8].law = Law::harmonic;
  drives[9].law = Law::uniform;
  for (int k = 0; k < 10; ++k) {
    const double c[8] = {0.3, -1.25, 2.0, 0.7, -0.6, 0.5, -0.4, 0.35};
    std::copy(c, c + 8, drives[k].c);
    if (k < 8) drives[k].law = Law::polynomial;
    if (k < 8) drives[k].terms = k + 1;
  }
  for (const Drive& drive : drives) {
    for (const Real t : {-1.5L, -0.1L, 0.0L, 0.7L, 2.0L}) {
      const slideway::LawValue law = slideway::law_at(drive, static_cast<double>(t), nullptr, 0);
      const Real exact_t = static_cast<double>(t), h = 1e-3L;
      const auto f = [&](int k) { return value(drive, exact_t + k * h); };
      // Central differences of order 4: h^4 f(5) / 30 and h^4 f(6) / 90, f(6) up to 4e3 here (7! c7 t); rounding 1e-19
      // / h^2.
      const Real rate = (8 * (f(1) - f(-1)) - (f(2) - f(-2))) / (12 * h);
      const Real acceleration = (16 * (f(1) + f(-1)) - (f(2) + f(-2)) - 30 * f(0)) / (12 * h * h);
      EXPECT_NEAR(law.value, static_cast<double>(f(0)), 1e-13);  // values up to 50: Horner's rounding
      EXPECT_NEAR(law.rate, static_cast<double>(rate), 1e-9);
      EXPECT_NEAR(law.acceleration, static_cast<double>(acceleration), 1e-9);
    }
  }
}

TEST(Drives, AnInputGoesOnThroughTheStepAsItsDerivativesSay) {
  Drive drive;
  drive.law = Law::input;
  drive.input = 1;
  const Input input[2] = {{9, 9, 9}, {1, 2, 3}};
  const slideway::LawValue law = slideway::law_at(drive, 77, input, 0.5);
  EXPECT_EQ(law.value, 1 + 2 * 0.5 + 3 * 0.125);  // exact in binary
  EXPECT_EQ(law.rate, 2 + 3 * 0.5);
  EXPECT_EQ(law.acceleration, 3);
}

// --- projection ------------------------------------------------------------------------------------------------------

/// The mass metric's square of a change of the coordinates: twice the kinetic energy that it is as a speed.
double squared(const Stepper& stepper, const State& at, const std::function<double(int)>& change) {
  State state = at;
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) state.v[j] = change(j);
  return 2 * stepper.kinetic_energy(state);
}

TEST(Project, LeavesAStartThatIsRightWhereItIs) {
  for (const char* scene : {"crank_rocker", "crank_rocker_offset", "squeezer", "gantry", "v_engine_8"}) {
    const Stepper stepper(shipped(scene));
    State state = stepper.start();
    const State before = state;
    ASSERT_EQ(stepper.project(state).status, Status::ok) << scene;
    for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
      // rad or m, and per second: the start's own rounding, at speeds of up to 225.
      EXPECT_NEAR(state.q[j], before.q[j], 1e-14) << scene << " " << j;
      EXPECT_NEAR(state.v[j], before.v[j], 1e-12) << scene << " " << j;
    }
  }
}

TEST(Project, BringsADisturbedStateOntoTheConstraintsByTheLeastChange) {
  for (const char* scene : {"crank_rocker_free", "crank_rocker_offset", "elliptic_trammel", "slider_crank", "squeezer",
                            "four_bar_chain", "v_engine_4"}) {
    const Stepper stepper(shipped(scene));
    const State right = started(stepper, 20, 5e-6);
    const int n = stepper.source.tables.coordinates;
    State state = right;
    double size = 0;
    for (int j = 0; j < n; ++j) size = std::fmax(size, std::fabs(right.v[j]));
    for (int j = 0; j < n; ++j) {
      state.q[j] += 1e-4 * std::cos(1.0 + 5 * j);
      state.v[j] += 1e-2 * size * std::sin(2.0 + 3 * j);
    }
    const State disturbed = state;
    ASSERT_EQ(stepper.project(state).status, Status::ok) << scene;
    EXPECT_EQ(state.steps, disturbed.steps);

    Reaction reaction;
    ASSERT_EQ(stepper.reaction(state, {}, reaction).status, Status::ok) << scene;
    // m; a few eps of distances up to 4 m. m/s; the same of the speeds.
    EXPECT_LT(reaction.drift_position, 1e-14) << scene;
    EXPECT_LT(reaction.drift_velocity, 1e-13 * std::fmax(1, size)) << scene;

    // The right state is on the constraints too, at a distance that the projection cannot exceed. To first order: the
    // constraints bend by 1e-4 of it, over lengths of 0.02 m and more.
    const double moved = squared(stepper, state, [&](int j) { return state.q[j] - disturbed.q[j]; });
    const double off = squared(stepper, state, [&](int j) { return right.q[j] - disturbed.q[j]; });
    EXPECT_LT(moved, 1.01 * off) << scene;
    EXPECT_GT(moved, 0) << scene;

    // Least: the speeds' change is orthogonal in the mass metric to what the constraints allow, such as the new speeds.
    const auto v = [&](int j) { return state.v[j]; };
    const auto change = [&](int j) { return state.v[j] - disturbed.v[j]; };
    const double vv = squared(stepper, state, v), cc = squared(stepper, state, change);
    const double sum = squared(stepper, state, [&](int j) { return v(j) + change(j); });
    EXPECT_LT(std::fabs(sum - vv - cc), 1e-12 * (vv + cc)) << scene;  // relative: rounding of the sums
    // And so is the positions' change, to first order.
    const auto shift = [&](int j) { return state.q[j] - disturbed.q[j]; };
    const auto along = [&](int j) { return shift(j) + 1e-4 / size * v(j); };
    const double ss = moved, ww = squared(stepper, state, [&](int j) { return 1e-4 / size * v(j); });
    EXPECT_LT(std::fabs(squared(stepper, state, along) - ss - ww), 0.02 * (ss + ww)) << scene;
  }
}

TEST(Project, PutsDrivenCoordinatesOnTheirLaws) {
  const Stepper stepper(shipped("gantry"));
  State state = stepper.start();
  state.start = 0.3;
  ASSERT_EQ(stepper.project(state).status, Status::ok);
  EXPECT_EQ(state.q[0], slideway::law_at(stepper.source.scene.drive[0], 0.3, nullptr, 0).value);
  EXPECT_EQ(state.v[4], slideway::law_at(stepper.source.scene.drive[1], 0.3, nullptr, 0).rate);
  Reaction reaction;
  ASSERT_EQ(stepper.reaction(state, {}, reaction).status, Status::ok);
  EXPECT_LT(reaction.drift_position, 1e-15);  // m; rounding of distances below 1 m
  EXPECT_LT(reaction.drift_velocity, 1e-15);
}

}  // namespace
