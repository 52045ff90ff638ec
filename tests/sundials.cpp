// A third opinion on the oracle's trajectories: SUNDIALS' integrators and root finders, on equations of motion written
// by hand, and on the oracle's Cartesian equations as an ODE (CVODE) and as a DAE of index 1 (IDA).
#include <gtest/gtest.h>

#ifndef SLIDEWAY_SUNDIALS

TEST(Sundials, NeedsDebianPackageLibsundialsDev) {
  GTEST_SKIP() << "SUNDIALS 6 was not found when this was built: install libsundials-dev";
}

#else

#include <algorithm>
#include <cmath>
#include <slideway/io/scene_file.hpp>
#include <slideway/oracle/trajectory.hpp>
#include <sstream>

#include "sundials/by_hand.hpp"
#include "sundials/cartesian.hpp"

namespace slideway::test {
namespace {

using oracle::Real;

constexpr double tolerances[] = {1e-6, 1e-8, 1e-10, 1e-12};
/// Errors allowed, in units of the tolerance asked for: this is one of the error made in a step, and errors add up over
/// some hundred steps and are magnified by events (a speed that is off by dv is zero dv / deceleration too late).
/// Measured: 2 to 160, at the finest tolerance, where rounding shows, 430 (the slider-crank by hand).
constexpr double most = 2000;

constexpr char block_on_belt[] = R"(
name = "block_on_belt"
gravity = [0.0, -9.81]
[[body]]
name = "belt"
parent = "ground"
joint = "prismatic"
mass = 1.0
inertia = 0.0
v = [0.1]
[[body]]
name = "block"
parent = "ground"
joint = "planar"
mass = 1.0
inertia = 0.01
q = [0.3, 0.0, 0.0]
v = [0.1, 0.0, 0.0]
[[guide]]
name = "face"
slider = "block"
rail = "belt"
origin = [0.0, 0.0]
direction = [1.0, 0.0]
contacts = [[-0.1, 0.0], [0.1, 0.0]]
mu = 0.1
mu_static = 0.15
[[drive]]
name = "motor"
body = "belt"
law = "uniform"
start = 0.0
rate = 0.1
[[spring]]
a = "block"
a_at = [0.0, 0.0]
b = "ground"
b_at = [0.0, 0.0]
stiffness = 2.0
length = 0.0
)";

struct Case {
  std::string scene;  ///< a shipped one, unless it is the belt
  std::vector<std::string> settings;
  double duration;  ///< s
  std::size_t events;
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }
};

const Case crank_rocker_free{"crank_rocker_free", {}, 1.0, 5};
const Case elliptic_trammel{"elliptic_trammel", {}, 1.2, 6};
const Case slider_crank{"slider_crank", {"guide.way.mu=0.2"}, 0.1, 14};  // two of them 2.3e-5 s apart
const Case belt{"block_on_belt", {}, 16, 4};
const Case quick_return{"quick_return", {}, 0.85, 7};

Scene<io::RunSize> read(const Case& c) {
  const auto reading = c.scene == belt.scene
                           ? io::parse_scene(block_on_belt, belt.scene)
                           : io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + c.scene + ".toml", c.settings);
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene ? reading.scene->scene : Scene<io::RunSize>{};
}

/// Guide by guide and contact by contact: what happens at one instant has no order.
std::vector<Event> by_place(std::vector<Event> events) {
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.where < b.where; });
  return events;
}

struct Truth {
  double duration, unit_q, unit_v;  ///< s; the largest coordinate and speed at start and end
  Vector joints;
  std::vector<Event> events;
};

Truth truth(const Case& c) {
  oracle::TrajectoryOptions options;
  options.digits = 20;  // of truncation: far below every tolerance
  oracle::Integrator<Real> integrator(oracle::model_of<Real>(read(c)), options);
  const auto trajectory = integrator.run(Real(c.duration), {Real(0), Real(c.duration)});
  Truth truth{c.duration, 0, 0, {}, {}};
  EXPECT_EQ(trajectory.end, oracle::End::duration) << "at " << trajectory.t << " s";
  EXPECT_EQ(trajectory.events.size(), c.events);
  for (const auto& sample : trajectory.samples) {
    truth.joints.clear();
    for (const Real& q : sample.q) truth.joints.push_back(static_cast<double>(q));
    for (const Real& q : sample.q) truth.unit_q = std::fmax(truth.unit_q, std::fabs(static_cast<double>(q)));
    for (const Real& v : sample.v) truth.joints.push_back(static_cast<double>(v));
    for (const Real& v : sample.v) truth.unit_v = std::fmax(truth.unit_v, std::fabs(static_cast<double>(v)));
  }
  for (const auto& e : trajectory.events) {
    const bool contact = e.contact != none;
    truth.events.push_back({static_cast<double>(e.t),
                            (contact ? "contact " : "guide ") + std::to_string(contact ? e.contact : e.guide),
                            name(e.kind)});
  }
  truth.events = by_place(truth.events);
  return truth;
}

/// The largest relative error of event times, final positions and final speeds.
double error(Motion& motion, const Truth& truth) {
  const std::vector<Event> events = by_place(motion.events);
  const Vector joints = motion.joints();
  EXPECT_EQ(joints.size(), truth.joints.size());
  EXPECT_EQ(events.size(), truth.events.size());
  if (events.size() != truth.events.size() || joints.size() != truth.joints.size()) return HUGE_VAL;
  double worst = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].where + " " + events[i].kind, truth.events[i].where + " " + truth.events[i].kind);
    worst = std::fmax(worst, std::fabs(events[i].t - truth.events[i].t) / truth.duration);
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double unit = i < joints.size() / 2 ? truth.unit_q : truth.unit_v;
    worst = std::fmax(worst, std::fabs(joints[i] - truth.joints[i]) / unit);
  }
  return worst;
}

/// At every tolerance down to `finest`.
template <class Make>
void expect_agreement(const Case& c, double finest, Make make) {
  const Truth expected = truth(c);
  if (testing::Test::HasFailure()) return;
  Vector errors;
  for (const double tolerance : tolerances) {
    if (tolerance < finest) break;
    SCOPED_TRACE(testing::Message() << "tolerance " << tolerance);
    auto motion = make();
    ASSERT_NO_THROW(run(motion, c.duration, tolerance));
    errors.push_back(error(motion, expected));
    EXPECT_LT(errors.back(), most * tolerance);
    std::ostringstream key;
    key << "error_over_" << tolerance;
    testing::Test::RecordProperty(key.str(), testing::PrintToString(errors.back() / tolerance));
  }
  EXPECT_LT(errors[2], errors[0] / 100);  // a tolerance 10^4 times smaller: at least half of its digits
}

TEST(SundialsByHand, CrankRockerAgreesWithTheOracle) {
  expect_agreement(crank_rocker_free, 1e-12, [] { return CrankRocker(); });
}

TEST(SundialsByHand, TrammelAgreesWithTheOracle) {
  expect_agreement(elliptic_trammel, 1e-12, [] { return Trammel(); });
}

TEST(SundialsByHand, SliderCrankAgreesWithTheOracle) {
  expect_agreement(slider_crank, 1e-12, [] { return SliderCrank(); });
}

TEST(SundialsByHand, BlockOnBeltAgreesWithTheOracle) {
  expect_agreement(belt, 1e-12, [] { return BlockOnBelt(); });
}

TEST(SundialsByHand, BlockOnBeltSticksAndSlipsForAsLongAsTheClosedFormSays) {
  // Slip starts at k x = mu_static m g and ends as far below the equilibrium with mu as it started above it; closed
  // form of its time: an arc of a harmonic motion of frequency sqrt(k / m) (docs/theory.md, where methods fail).
  constexpr double slip = 2.6184222465698971961, stick = 4.905, start = (0.15 * gravity / 2 - 0.3) / 0.1;
  BlockOnBelt block;
  run(block, belt.duration, 1e-10);
  ASSERT_EQ(block.events.size(), 4u);
  const double bound = most * 1e-10 * belt.duration;
  EXPECT_NEAR(block.events[0].t, start, bound);
  EXPECT_NEAR(block.events[1].t, start + slip, bound);
  EXPECT_NEAR(block.events[2].t, start + slip + stick, bound);
  EXPECT_NEAR(block.events[3].t, start + slip + stick + slip, bound);
}

class SundialsOnScene : public testing::TestWithParam<Case> {};

TEST_P(SundialsOnScene, CvodeAgreesWithTheOracle) {
  const auto scene = read(GetParam());
  const auto exact = oracle::model_of<Real>(scene);
  const auto model = oracle::model_of<double>(scene);
  expect_agreement(GetParam(), 1e-12, [&] { return CartesianOde(exact, model); });
}

// To 1e-10: at 1e-12 the backward differences of order five are at the rounding of their Newton iteration.
TEST_P(SundialsOnScene, IdaAgreesWithTheOracle) {
  const auto scene = read(GetParam());
  const auto exact = oracle::model_of<Real>(scene);
  const auto model = oracle::model_of<double>(scene);
  expect_agreement(GetParam(), 1e-10, [&] { return CartesianDae(exact, model); });
}

INSTANTIATE_TEST_SUITE_P(Scenes, SundialsOnScene,
                         testing::Values(crank_rocker_free, elliptic_trammel, slider_crank, belt, quick_return),
                         [](const auto& chosen) { return chosen.param.scene; });

}  // namespace
}  // namespace slideway::test

#endif
