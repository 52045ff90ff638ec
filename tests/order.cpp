// The order of the methods, where the motion is smooth: no slip and no contact force reverses.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <slideway/io/stepper.hpp>
#include <string>

namespace {

using slideway::Method;
using slideway::Report;
using slideway::Status;
using Stepper = slideway::RunTimeStepper<slideway::io::RunSize>;
using State = Stepper::State;

/// A stretch of a scene's run between two events. Step sizes are (to - from) / steps and its halves.
struct Window {
  const char* scene;
  double from, to;  ///< s
  int rk4_steps, euler_steps;
};

void PrintTo(const Window& window, std::ostream* out) { *out << window.scene; }

/// The state at the end of the window, in so many steps. Any event on the way is a failure of the test's data.
State end_of(const Stepper& stepper, State state, double length, int steps) {
  state.start = state.time();
  state.steps = 0;
  for (int k = 0; k < steps; ++k) {
    const Report report = stepper.step(state, length / steps);
    EXPECT_EQ(report.status, Status::ok) << sentence(report.status);
    EXPECT_EQ(report.unlocated_events, 0) << "at " << state.time() << " s";
    if (report.status != Status::ok) break;
  }
  return state;
}

/// The order that the errors of q show with `steps`, 2 `steps` and 4 `steps` against rk4 with 64 `fine` steps: the
/// slope of the line through them, which is log2 of the first error over the last, halved.
double order_of(const Window& window, Method method, int steps, double& last_error) {
  const auto reading = slideway::io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + std::string(window.scene) + ".toml");
  EXPECT_TRUE(reading.scene);
  if (!reading.scene) return 0;
  Stepper stepper(reading.scene->scene);
  State start = stepper.start();
  if (window.from > 0) {
    const int before = 2000;
    for (int k = 0; k < before; ++k) EXPECT_EQ(stepper.step(start, window.from / before).status, Status::ok);
    EXPECT_EQ(stepper.project(start).status, Status::ok);
  }
  const double length = window.to - window.from;
  const State truth = end_of(stepper, start, length, 64 * window.rk4_steps);
  stepper.method = method;
  stepper.drift_limit = 1;  // coarse steps drift
  double error[3];
  for (int k = 0; k < 3; ++k) {
    const State end = end_of(stepper, start, length, steps << k);
    double squares = 0;
    for (int j = 0; j < stepper.source.tables.coordinates; ++j) squares += std::pow(end.q[j] - truth.q[j], 2);
    error[k] = std::sqrt(squares);
  }
  last_error = error[2];
  return std::log2(error[0] / error[2]) / 2;
}

class Order : public testing::TestWithParam<Window> {};

TEST_P(Order, OfRk4IsFour) {
  double last_error = 0;
  const double order = order_of(GetParam(), Method::rk4, GetParam().rk4_steps, last_error);
  EXPECT_GT(order, 3.9);  // the project's bar
  EXPECT_LT(order, 4.1);
  // rad or m: a hundred times what a few hundred roundings of 1e-16 make, and what rk4 with a 16th of the step has
  // left.
  EXPECT_GT(last_error, 1e-12);
  RecordProperty("order", testing::PrintToString(order));
}

TEST_P(Order, OfEulerIsOne) {
  double last_error = 0;
  const double order = order_of(GetParam(), Method::euler, GetParam().euler_steps, last_error);
  EXPECT_GT(order, 0.9);  // the project's bar
  EXPECT_LT(order, 1.1);
  RecordProperty("order", testing::PrintToString(order));
}

INSTANTIATE_TEST_SUITE_P(
    , Order,
    testing::Values(Window{"crank_rocker", 0, 0.5, 20, 200}, Window{"crank_rocker_free", 0.3, 1, 200, 500},
                    Window{"crank_rocker_offset", 0.32, 0.82, 160, 500}, Window{"elliptic_trammel", 0, 0.19, 20, 500},
                    Window{"rod_on_two_guides", 0, 0.1, 10, 200}, Window{"slider_crank_driven", 0, 0.22, 20, 500},
                    Window{"squeezer", 0, 0.005, 80, 1000}, Window{"four_bar_chain", 0, 0.5, 10, 200}),
    [](const auto& instance) { return std::string(instance.param.scene); });

}  // namespace
