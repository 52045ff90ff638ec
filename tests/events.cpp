// Located events: where they are, how many, what they cost, and that the order of the method is kept across them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <slideway/oracle/trajectory.hpp>
#include <support/oracle.hpp>
#include <support/steppers.hpp>

namespace {

using namespace slideway;
using namespace slideway::test;
using oracle::Trajectory;

struct Case {
  const char* scene;
  std::vector<std::string> settings;
  double duration;
  int events;  ///< at least
  int rk4_steps, dop853_steps;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }

Trajectory<Real> exact(const Case& c) {
  oracle::TrajectoryOptions options;
  return oracle::Integrator<Real>(shipped(c.scene, c.settings), options).run(Real(c.duration), {Real(c.duration)});
}

/// Largest error of q over the largest |q|, at the end of a run.
double error_of(const Case& c, Method method, int steps, const Trajectory<Real>& truth, std::size_t& events) {
  const RunStepper stepper = stepper_of(c.scene, method, c.settings);
  RunState state = stepper.start();
  EXPECT_EQ(stepper.project(state).status, Status::ok);
  const History r = run(stepper, state, c.duration / steps, steps);
  EXPECT_EQ(r.last.status, Status::ok) << sentence(r.last.status) << " at " << r.state.time();
  events = r.events.size();
  double error = 0, size = 0;
  for (std::size_t j = 0; j < truth.samples.back().q.size(); ++j) {
    const double q = static_cast<double>(truth.samples.back().q[j]);
    error = std::fmax(error, std::fabs(r.state.q[j] - q));
    size = std::fmax(size, std::fabs(q));
  }
  return error / size;
}

class Order : public testing::TestWithParam<Case> {};

/// The slope of the errors with steps, 2 steps, 4 steps; those that rounding rules are left out.
double slope(const Case& c, Method method, int steps, const Trajectory<Real>& truth, double floor) {
  std::vector<double> errors;
  for (int k = 0; k < 4; ++k) {
    std::size_t events = 0;
    errors.push_back(error_of(c, method, steps << k, truth, events));
    EXPECT_EQ(events, truth.events.size()) << name(method) << ", " << (steps << k) << " steps";
  }
  std::size_t last = errors.size() - 1;
  while (last > 1 && errors[last] < floor) --last;
  for (std::size_t k = 0; k < errors.size(); ++k)
    testing::Test::RecordProperty(std::string(name(method)) + "_" + std::to_string(steps << k),
                                  testing::PrintToString(errors[k]));
  return std::log2(errors[0] / errors[last]) / static_cast<double>(last);
}

TEST_P(Order, IsKeptAcrossEvents) {
  const Case& c = GetParam();
  const Trajectory<Real> truth = exact(c);
  ASSERT_EQ(truth.end, oracle::End::duration);
  ASSERT_GE(static_cast<int>(truth.events.size()), c.events);
  const double rk4 = slope(c, Method::rk4_located, c.rk4_steps, truth, 1e-12);
  const double dop853 = slope(c, Method::dop853_located, c.dop853_steps, truth, 1e-12);
  EXPECT_GE(rk4, 3.8);
  EXPECT_GE(dop853, 7.5);
  RecordProperty("events", static_cast<int>(truth.events.size()));
  RecordProperty("rk4_located", testing::PrintToString(rk4));
  RecordProperty("dop853_located", testing::PrintToString(dop853));
}

// The belt's gains hold what rounding makes of the block's angle: without them one rounding of a contact force turns it
// by 5e-12 rad in 40 s.
INSTANTIATE_TEST_SUITE_P(Scenes, Order,
                         testing::Values(Case{"slider_crank", {"guide.way.mu=0.2"}, 0.06, 8, 600, 150},
                                         Case{"crank_rocker_free", {}, 2.6, 8, 400, 60},
                                         Case{"belt", {}, 40, 8, 640, 40}),
                         [](const auto& one) { return std::string(one.param.scene); });

TEST(EventTimes, OfTheSliderCrankAreThoseOfTheOracle) {
  // Two pairs of events are less than 1.1e-4 s apart.
  const Case c{"slider_crank", {"guide.way.mu=0.2"}, 0.1, 8, 0, 0};
  const Trajectory<Real> truth = exact(c);
  for (const Method method : located) {
    const RunStepper stepper = stepper_of(c.scene, method, c.settings);
    const History r = run(stepper, stepper.start(), 1e-5, 10000);
    ASSERT_EQ(r.events.size(), truth.events.size()) << name(method);
    double worst = 0;
    for (const auto& event : truth.events) {
      double nearest = 1;
      for (const Event& found : r.events) {
        const int contact = event.contact == none ? none : event.contact;
        if (found.kind == event.kind && found.contact == contact) {
          nearest = std::fmin(nearest, std::fabs(found.t - static_cast<double>(event.t)));
        }
      }
      worst = std::fmax(worst, nearest);
    }
    EXPECT_LT(worst, 1e-10) << name(method);
    RecordProperty(std::string(name(method)), testing::PrintToString(worst));
  }
  double closest = 1;
  for (std::size_t k = 1; k < truth.events.size(); ++k) {
    const double apart = static_cast<double>(truth.events[k].t - truth.events[k - 1].t);
    if (apart > 1e-9) closest = std::fmin(closest, apart);
  }
  EXPECT_LT(closest, 1.1e-4);
}

TEST(EventsInOneStep, AreFoundOneByOneAndAtOneInstant) {
  // Two contacts of a slider change their signs together; a coarse step has several events.
  for (const Method method : located) {
    const RunStepper stepper = stepper_of("slider_crank", method);
    RunState state = stepper.start();
    const Report report = stepper.step(state, 2e-5);
    ASSERT_EQ(report.status, Status::ok);
    ASSERT_EQ(report.events, 2);
    EXPECT_EQ(report.event[0].t, report.event[1].t);
    EXPECT_EQ(report.event[0].contact + report.event[1].contact, 1);
  }
  const RunStepper coarse = stepper_of("crank_rocker_free", Method::dop853_located);
  RunState state = coarse.start();
  int most = 0;
  for (int k = 0; k < 20; ++k) {
    const Report report = coarse.step(state, 0.05);
    ASSERT_EQ(report.status, Status::ok);
    most = std::max(most, report.events);
  }
  EXPECT_GE(most, 2);
}

/// A block on a plane, pushed by a live input, force in N.
struct Pushed {
  RunStepper stepper;
  RunStepper::Inputs inputs;
  explicit Pushed(Method method, const std::vector<std::string>& settings = {})
      : stepper([&] {
          Scene<Room> scene = scene_of("pushed_block", settings);
          scene.inputs = 1;
          scene.load[0].input = 0;
          scene.load[0].force = {1, 0};
          RunStepper s(scene);
          s.method = method;
          return s;
        }()) {}
};

TEST(GrazingEvents, AreNoEvents) {
  // The push rises as 4 t^2 from -0 to touch... and falls: |F| reaches 10 N from below at the middle of the step, and
  // is less on both sides.
  for (const Method method : located) {
    for (const double excess : {-1e-3, -1e-9}) {
      Pushed p(method);
      RunState state = p.stepper.start();
      const double h = 0.1, peak = 10 + excess;
      // value + rate tau + acceleration tau^2 / 2 has its peak at h / 2.
      const double acceleration = -800;
      p.inputs.input[0] = {peak + acceleration * h * h / 8, -acceleration * h / 2, acceleration};
      const Report report = p.stepper.step(state, h, p.inputs);
      EXPECT_EQ(report.status, Status::ok);
      EXPECT_EQ(report.events, 0) << name(method) << " " << excess;
      EXPECT_LT(std::fabs(state.q[0]), 1e-13);
    }
  }
}

TEST(GrazingEvents, ThatPassTheLimitInTheMiddleOfAStepAreFound) {
  // As above, but 0.1 N beyond the limit for a moment: it breaks away, slides, and comes to rest again.
  for (const Method method : located) {
    Pushed p(method);
    RunState state = p.stepper.start();
    const double h = 0.1, peak = 10.1, acceleration = -800;
    p.inputs.input[0] = {peak + acceleration * h * h / 8, -acceleration * h / 2, acceleration};
    const Report report = p.stepper.step(state, h, p.inputs);
    ASSERT_EQ(report.status, Status::ok);
    ASSERT_EQ(report.events, 2) << name(method);
    EXPECT_EQ(report.event[0].kind, EventKind::slip);
    EXPECT_EQ(report.event[1].kind, EventKind::stick);
    // 400 s^2 = 0.1: s = 1/sqrt(4000) before the peak; v = (0.1 x - 400/3 x^3)/m from there vanishes at twice... the
    // speed is zero again where the integral of 0.1 - 400 s^2 from -s0 to s is: s = 2 s0.
    const double s0 = std::sqrt(0.1 / 400);
    EXPECT_NEAR(report.event[0].t, h / 2 - s0, 1e-12);
    EXPECT_NEAR(report.event[1].t, h / 2 + 2 * s0, 1e-12);
  }
}

TEST(EventLimit, LeavesTheStateAsItWas) {
  // Hundreds of stick-slip periods in one step.
  for (const Method method : located) {
    RunStepper stepper = stepper_of("belt", method, {"baumgarte.alpha=0.0", "baumgarte.beta=0.0"});
    RunState state = stepper.start();
    const History warm = run(stepper, state, 1e-3, 10);
    state = warm.state;
    const RunState before = state;
    const Report report = stepper.step(state, 3000);
    EXPECT_EQ(report.status, Status::event_limit) << name(report.status);
    EXPECT_TRUE(state == before);
    stepper.max_events = 1;
    state = warm.state;
    EXPECT_EQ(stepper.step(state, 16).status, Status::event_limit);
    EXPECT_TRUE(state == before);
    stepper.max_events = Report::room + 1;  // more than the report holds
    EXPECT_EQ(stepper.step(state, 1e-3).status, Status::invalid_input);
  }
}

TEST(Evaluations, OfAStepWithoutEventAreThoseOfTheMethod) {
  for (const auto& [method, stages] : {std::pair(Method::rk4_located, 4), std::pair(Method::dop853_located, 12)}) {
    const RunStepper stepper = stepper_of("overhung_slider", method);
    RunState state = stepper.start();
    const Report report = stepper.step(state, 1e-3);
    EXPECT_EQ(report.evaluations, stages);
  }
}

/// Worst over median evaluations a step, over all scenes: docs/theory.md states it.
TEST(Evaluations, AreBoundedOverAllScenes) {
  int worst = 0;
  for (const char* scene : {"belt", "block_on_plane", "crank_rocker", "crank_rocker_free", "crank_rocker_offset",
                            "elliptic_trammel", "gantry", "quick_return", "slider_crank", "v_engine_4"}) {
    for (const auto& [method, stages] : {std::pair(Method::rk4_located, 4), std::pair(Method::dop853_located, 12)}) {
      const auto file = io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + std::string(scene) + ".toml");
      const RunStepper stepper = stepper_of(scene, method);
      RunState state = stepper.start();
      std::vector<int> counts;
      const auto steps = static_cast<long long>(file.scene->run.duration / file.scene->run.dt);
      for (long long k = 0; k < steps; ++k) {
        const Report report = stepper.step(state, file.scene->run.dt);
        ASSERT_EQ(report.status, Status::ok) << scene;
        counts.push_back(report.evaluations);
      }
      std::sort(counts.begin(), counts.end());
      EXPECT_EQ(counts[counts.size() / 2], stages) << scene;
      const int most = counts.back();
      worst = std::max(worst, (most + stages - 1) / stages);
      const int contacts_and_guides = stepper.source.tables.contacts + stepper.source.scene.guides;
      const int cap = (stepper.max_events + contacts_and_guides + most_pieces + 1) * evaluations_of_a_round(stages);
      EXPECT_LE(most, cap);
      RecordProperty(std::string(scene) + "_" + name(method), most);
    }
  }
  RecordProperty("worst_over_median", worst);
}

}  // namespace
