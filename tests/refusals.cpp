// Options that are none, states that cannot be moved onto their constraints, and what is withdrawn rather than refused.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <limits>
#include <slideway/hlcp.hpp>
#include <slideway/io/stepper.hpp>

namespace {

using namespace slideway;

using Room = io::RunSize;  // the stepper that is compiled already
using Stepping = RunTimeStepper<Room>;

/// A block whose two feet slide on a line along the ground.
Scene<Room> block() {
  Scene<Room> scene;
  scene.gravity = {0, -9.81};
  scene.bodies = scene.guides = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = 1;
  scene.body[0].inertia = 0.1;
  scene.guide[0].contacts = 2;
  scene.guide[0].contact[0] = {-0.5, 0};
  scene.guide[0].contact[1] = {0.5, 0};
  return scene;
}

template <class T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(Refusals, OfOptionsOutOfRangeLeaveTheState) {
  const auto expect_refused = [](const char* what, auto&& change) {
    Stepping stepper(block());
    Stepping::State state = stepper.start();
    ASSERT_EQ(stepper.step(state, 1e-3).status, Status::ok);
    change(stepper);
    const Stepping::State before = state;
    EXPECT_EQ(stepper.step(state, 1e-3).status, Status::invalid_input) << what;
    EXPECT_TRUE(same_bytes(state, before)) << what;
  };
  for (const double theta : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    expect_refused("theta", [&](Stepping& s) { s.theta = theta; });
  }
  expect_refused("method", [](Stepping& s) { s.method = static_cast<Method>(std::size(methods)); });
  expect_refused("max_events", [](Stepping& s) { s.max_events = Report::room + 1; });
}

TEST(Refusals, OfProjectionLeaveTheState) {
  const auto expect_refused = [](const Scene<Room>& scene, double x, Status status) {
    const Stepping stepper(scene);
    Stepping::State state = stepper.start();
    state.q[0] = x;
    const Stepping::State before = state;
    EXPECT_EQ(stepper.project(state).status, status);
    EXPECT_TRUE(same_bytes(state, before));
  };
  Scene<Room> scene = block();
  scene.body[0].mass = 0;
  expect_refused(scene, 0, Status::singular_constraints);  // moves nothing, so no change of it is the least
  scene = block();
  scene.guides = 0;
  scene.pins = 1;
  scene.pin[0].b_at = {1.5e308, 1};
  expect_refused(scene, -1.5e308, Status::no_convergence);  // apart by more than a double can say
}

TEST(Hlcp, HasNoSolutionToHandOutWhereItRefuses) {
  Eigen::Matrix2d plus, minus;
  plus << -1, 0, 0, 1;
  minus << 5, 0, 0, 1;
  const auto refused = solve_hlcp(plus, minus, Eigen::Vector2d(1, 1));  // 2 u - 3 |u| = 1
  EXPECT_EQ(refused.status, Status::no_solution);
  EXPECT_EQ(refused.x, Eigen::Vector2d::Zero());
  using Bounded = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 32, 32>;
  using BoundedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 32, 1>;
  const Bounded square = Bounded::Identity(3, 3);
  EXPECT_EQ(solve_hlcp(square, Bounded(3, 2), BoundedVector::Ones(3).eval()).status, Status::invalid_input);
}

TEST(Hlcp, ATieThatLeadsAwayFromTheSolutionCostsSolvesNotTheAnswer) {
  // A solution with ties is found from the signs given, but not from the signs that do not depend on them, from which
  // ties are tried again.
  const double plus[5][5] = {
      {-1, 1, 0, -1, -1}, {-1, 1, 0, 0, 1}, {0, -1, 0, 0, -1}, {-1, 0, 0, 0, 0}, {-1, -1, 1, 0, -1}};
  const double minus[5][5] = {{1, 0, 0, -1, 0}, {0, 0, 0, 1, 0}, {-1, 0, 0, 1, 1}, {1, 1, 0, 0, -1}, {0, -1, -1, 1, 1}};
  const signed char start[5] = {-1, 1, -1, -1, 1};
  Hlcp<5> problem = {};
  std::memcpy(problem.plus, plus, sizeof plus);
  std::memcpy(problem.minus, minus, sizeof minus);
  problem.b[4] = 2;
  const auto answer = [&](int max_solves) {
    HlcpSolution<5> solution = {};
    std::memcpy(solution.sign, start, sizeof start);
    HlcpOptions options;
    options.max_solves = max_solves;
    solve(problem, 5, solution, options);
    return solution;
  };
  const HlcpSolution<5> found = answer(HlcpOptions{}.max_solves);
  ASSERT_EQ(found.status, Status::ok) << name(found.status);
  for (int i = 0; i < 5; ++i) {
    double sum = -problem.b[i];
    for (int j = 0; j < 5; ++j) sum += (found.x[j] < 0 ? minus[i][j] : plus[i][j]) * found.x[j];
    EXPECT_NEAR(sum, 0, 1e-14) << i;
  }
  for (int limit = 1; limit < found.solves; ++limit) {
    const HlcpSolution<5> refused = answer(limit);
    EXPECT_NE(refused.status, Status::ok) << limit;
    EXPECT_LE(refused.solves, limit);
  }
}

// ---- guides at rest and their friction

/// A rod whose end is on a line along the ground, leaning by `angle`: Painleve's, for much friction.
Scene<Room> rod(double mu, double angle) {
  Scene<Room> scene = block();
  scene.body[0].com = {1, 0};
  scene.body[0].inertia = 1.0 / 3;
  scene.body[0].q[2] = angle;
  scene.guide[0].contacts = 1;
  scene.guide[0].contact[0] = {0, 0};
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  return scene;
}

TEST(Rest, ASlideThatWasProposedAndHasNoSolutionIsWithdrawn) {
  int rests = 0;
  for (double angle = 0.1; angle < 3.1; angle += 0.1) {
    const Stepping stepper(rod(2.5, angle));
    Stepping::State open = stepper.start();
    Stepping::Reaction asked;
    const Report without = stepper.reaction(open, {}, asked);
    for (const int mode : {-1, 1}) {
      Stepping::State proposed = open;
      proposed.decided = true;  // that it slides, by whoever set the state
      proposed.mode[0] = static_cast<signed char>(mode);
      Stepping::Reaction found;
      const Report with = stepper.reaction(proposed, {}, found);
      ASSERT_EQ(without.status, Status::ok) << angle;
      EXPECT_NE(with.status, Status::no_solution) << angle;  // several, where it slides
      if (with.status != Status::ok || std::fabs(found.acceleration[0]) > 1e-9) continue;
      ++rests;
      EXPECT_NEAR(found.lambda[0], asked.lambda[0], 1e-12 * std::fabs(asked.lambda[0])) << angle;
      EXPECT_NEAR(found.friction[0], asked.friction[0], 1e-12 * std::fabs(asked.lambda[0])) << angle;
      EXPECT_LE(std::fabs(found.friction[0]), 2.5 * std::fabs(found.lambda[0])) << angle;
    }
  }
  EXPECT_GT(rests, 20);
}

/// Events of a block that slides while a force grows that lifts it: from 9 N by 2 N in the step.
Report lifted(double mu, double preload) {
  Scene<Room> scene = block();
  scene.body[0].v[0] = 5;
  scene.guide[0].mu = scene.guide[0].mu_static = mu;
  scene.guide[0].preload = preload;
  scene.loads = scene.inputs = 1;
  scene.load[0].force = {0, 1};
  scene.load[0].input = 0;
  Stepping stepper(scene);
  stepper.method = Method::rk4_located;
  Stepping::State state = stepper.start();
  Inputs<Room> inputs;
  inputs.input[0] = {9, 20, 0};
  EXPECT_EQ(stepper.step(state, 1e-6, inputs).status, Status::ok);
  const Report report = stepper.step(state, 0.1, inputs);
  inputs.input[0] = {11, 0, 0};
  EXPECT_EQ(stepper.step(state, 1e-6, inputs).events, 0);
  return report;
}

TEST(Events, AContactForceThatMattersToNoFrictionReversesUnseen) {
  const Report with = lifted(0.1, 0.5);
  ASSERT_EQ(with.status, Status::ok);
  ASSERT_EQ(with.events, 2);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(with.event[k].kind, EventKind::normal_reversal);
    EXPECT_NEAR(with.event[k].t, (9.81 - 9) / 20, 1e-5);  // of the inputs' time, which began anew with the step
  }
  const Report without = lifted(0, 0.5);
  ASSERT_EQ(without.status, Status::ok);
  EXPECT_EQ(without.events, 0) << "friction that is a preload does not ask for the force";
  EXPECT_EQ(without.unlocated_events, 0);
}

}  // namespace
