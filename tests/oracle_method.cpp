// The oracle's steps of the kernel's methods: what they are in 50 digits, and that the kernel's are these in doubles.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <ostream>
#include <slideway/io/scene_file.hpp>
#include <slideway/io/stepper.hpp>
#include <slideway/oracle/method.hpp>
#include <slideway/oracle/trajectory.hpp>
#include <string>

namespace {

using slideway::Report;
using slideway::Status;
using slideway::oracle::FrictionLaw;
using slideway::oracle::Integrator;
using slideway::oracle::Method;
using slideway::oracle::Model;
using slideway::oracle::model_of;
using slideway::oracle::Real;
using slideway::oracle::Scheme;
using slideway::oracle::TreeState;
using slideway::oracle::Verdict;
using Stepper = slideway::RunTimeStepper<slideway::io::RunSize>;

slideway::io::SceneFile scene_file(const std::string& name) {
  auto reading = slideway::io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml");
  EXPECT_TRUE(reading.scene) << name;
  return reading.scene.value_or(slideway::io::SceneFile{});
}

/// A model with what steps it.
struct Exact {
  explicit Exact(const Model<Real>& data) : model(data) {}
  Model<Real> model;
  slideway::oracle::Dynamics<Real> dynamics{model, FrictionLaw<Real>::orders};
  FrictionLaw<Real> law{dynamics};
  Method<Real> method{dynamics, law};
  TreeState<Real> start() const { return {Real(0), model.start.q, model.start.v}; }
};

/// Largest magnitude, and largest difference.
double size(const std::vector<Real>& x) {
  double most = 0;
  for (const Real& y : x) most = std::max(most, std::fabs(static_cast<double>(y)));
  return most;
}
double distance(std::vector<Real> x, const std::vector<Real>& y) {
  for (std::size_t j = 0; j < x.size(); ++j) x[j] -= y[j];
  return size(x);
}

TreeState<Real> exact(const Stepper& stepper, const Stepper::State& state) {
  TreeState<Real> same{Real(state.time()), {}, {}};
  for (int g = 0; g < stepper.source.scene.guides; ++g) {
    same.rests.push_back(stepper.source.tables.is_rough[g] && state.decided && state.mode[g] == 0);
  }
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
    same.q.emplace_back(state.q[j]);
    same.v.emplace_back(state.v[j]);
  }
  return same;
}

struct Case {
  const char* scene;
  int states;  ///< along the run; few where many contacts make the exact law slow
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }

class OracleMethod : public testing::TestWithParam<Case> {};

/// Roundings of a step, u = 2^-53: the acceleration is good to the self-check's bound on its equations,
/// A = 4 u items^2 of the largest, or of what forces would do `alone` (m/s^2) where they cancel; through v and q it is
/// multiplied by h, `weight` times where weights b of both signs do not add up to 1, and h^2; and v, q take two
/// roundings of their own size in the last sum and its terms, and q as many of h v. (The prescribed acceleration of a
/// drive has the roundings of q - f(t) times beta and so on: with h^2 beta <= 1 they count as one more of q.)
void expect_close(const Stepper& stepper, const TreeState<Real>& from, double h, double alone, double weight,
                  const TreeState<Real>& kernel, const TreeState<Real>& truth) {
  const auto& table = stepper.source.tables;
  const double u = 0x1p-53, items = table.coordinates + table.contacts + table.ideal + stepper.source.scene.bodies;
  const double v = std::max(size(from.v), size(truth.v)), a = std::max(distance(truth.v, from.v) / h, alone);
  const double v_bound = 4 * u * v + h * weight * (4 * u * items * items) * a;
  EXPECT_LE(distance(kernel.v, truth.v), v_bound) << v;
  EXPECT_LE(distance(kernel.q, truth.q), 4 * u * (size(truth.q) + h * v) + h * v_bound) << size(truth.q);
}

/// What forces would do alone, in the dynamics' last solution, to a mechanism that is driven or of which something
/// rests.
double alone(const Exact& oracle, const std::vector<bool>& rests) {
  Real most(0);
  if (oracle.model.drive.empty() && std::find(rests.begin(), rests.end(), true) == rests.end()) return 0;
  for (int i = 0; i < 3 * oracle.dynamics.mechanism.bodies(); ++i) {
    most = std::max(most, Real(oracle.dynamics.load(i) / oracle.dynamics.mechanism.mass(i)));
  }
  return static_cast<double>(most);
}

TEST_P(OracleMethod, KernelStepsDifferByRoundingAlone) {
  const auto file = scene_file(GetParam().scene);
  const auto stepper = std::make_unique<Stepper>(file.scene);  // too large for some stacks
  Exact oracle(model_of<Real>(file.scene));
  const double h = file.run.dt;
  const int steps = static_cast<int>(file.run.duration / h), states = GetParam().states;
  Stepper::State state = stepper->start();
  for (int k = 0, compared = 0; compared < states; ++k) {
    if (k == (2 * compared + 1) * steps / (2 * states)) {
      const TreeState<Real> from = exact(*stepper, state);
      for (const Scheme scheme : {Scheme::rk4, Scheme::euler, Scheme::rk4_located, Scheme::dop853_located}) {
        Stepper::State next = state;
        stepper->method = method_of(scheme);
        const Report report = stepper->step(next, h);
        ASSERT_EQ(report.status, Status::ok);
        if (report.events > 0) continue;  // cut there
        TreeState<Real> truth;
        ASSERT_TRUE(Method<Real>::goes_on(oracle.method.step(scheme, from, Real(h), truth)));
        const double weight = static_cast<double>(slideway::oracle::runge_kutta<Real>(scheme).weight());
        SCOPED_TRACE(std::string(name(scheme)) + " from t = " + testing::PrintToString(state.time()));
        expect_close(*stepper, from, h, alone(oracle, truth.rests), weight, exact(*stepper, next), truth);
        const auto drift = oracle.method.largest_drift(from);
        // m | rad: a hundred roundings of places of some metres and of angles of some turns, and of speeds.
        EXPECT_NEAR(report.drift_position, static_cast<double>(drift.position), 1e-14 * (1 + size(from.q)));
        EXPECT_NEAR(report.drift_velocity, static_cast<double>(drift.velocity), 1e-14 * (1 + size(from.v)));
      }
      stepper->method = slideway::Method::rk4;
      ++compared;
    }
    ASSERT_EQ(stepper->step(state, h).status, Status::ok) << state.time();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, OracleMethod,
    testing::Values(Case{"belt", 8}, Case{"block_on_plane", 4}, Case{"pushed_block", 2}, Case{"trammel_at_rest", 2},
                    Case{"crank_rocker", 4}, Case{"crank_rocker_free", 4}, Case{"crank_rocker_offset", 4},
                    Case{"crank_rocker_two_contacts", 4}, Case{"crank_rocker_weightless", 4},
                    Case{"elliptic_trammel", 8}, Case{"four_bar_chain", 4}, Case{"gantry", 4},
                    Case{"overhung_slider", 4}, Case{"quick_return", 4}, Case{"rod_on_two_guides", 4},
                    Case{"slider_crank", 4}, Case{"slider_crank_driven", 4}, Case{"squeezer", 4}, Case{"v_engine_2", 2},
                    Case{"v_engine_4", 1}, Case{"v_engine_8", 2}, Case{"v_engine_16", 1}, Case{"high_mass_ratio", 4},
                    Case{"painleve_klein", 4}, Case{"painleve_rod", 4}, Case{"slider_crank_equal", 4}),
    [](const auto& test) { return std::string(test.param.scene); });

/// The error of q and v at `length` s in so many steps, against the trajectory by Taylor series.
double error_after(Exact& oracle, Scheme scheme, const Real& length, int steps, const TreeState<Real>& truth) {
  TreeState<Real> state = oracle.start(), next;
  for (int k = 0; k < steps; ++k) {
    EXPECT_EQ(oracle.method.step(scheme, state, Real(length / steps), next), Verdict::unique);
    state = next;
  }
  return std::max(distance(state.q, truth.q), distance(state.v, truth.v));
}

/// Before the first event: at 0.195 s of the trammel, 0.18 s of the driven slider-crank.
TEST(OracleMethodOrder, IsFourForRk4EightForDop853AndOneForEuler) {
  for (const char* scene : {"elliptic_trammel", "slider_crank_driven"}) {
    SCOPED_TRACE(scene);
    Exact oracle(model_of<Real>(scene_file(scene).scene));
    const Real length = Real(1) / 16;
    Integrator<Real> series(oracle.model, {});
    const auto run = series.run(length, {length});
    ASSERT_EQ(run.samples.size(), 1U);
    ASSERT_TRUE(run.events.empty());
    const TreeState<Real> truth{length, run.samples[0].q, run.samples[0].v};
    const auto ratio = [&](Scheme scheme, int steps) {
      return error_after(oracle, scheme, length, steps, truth) / error_after(oracle, scheme, length, 2 * steps, truth);
    };
    EXPECT_NEAR(ratio(Scheme::rk4, 32), 16, 1.6);
    EXPECT_EQ(ratio(Scheme::rk4_located, 32), ratio(Scheme::rk4, 32));  // nothing changes its mode
    EXPECT_NEAR(ratio(Scheme::dop853_located, 4), 256, 80);
    EXPECT_NEAR(ratio(Scheme::euler, 32), 2, 0.2);
  }
}

/// The overhung slider, 1 kg, 10 N of weight on its way: with another mu, speed, torque, and a push along the way.
Model<Real> block(double mu, double speed, double torque, double push) {
  Model<Real> model = model_of<Real>(scene_file("overhung_slider").scene);
  model.guide[0].mu = model.guide[0].mu_static = Real(mu);
  model.start.v[0] = Real(speed);
  model.load[0].torque = Real(torque);
  model.load[0].force = {Real(push), Real(0)};
  return model;
}

/// Friction along the way takes 2.5 N: with normal forces N1 + N2 = 10, the moments about the centre give
/// 0.05 (N1 - N2) = 0.5 + 0.3 (5 - 0.1 D), D = |N1| + |N2|; N2 < 0, so N1 - N2 = D = 25.
TEST(OracleMethodFriction, LetsAGuideLeaveRestInTheFirstStage) {
  Exact oracle(block(0.1, 0, 0.5, 5));
  const Real h(0x1p-10);
  TreeState<Real> next;
  ASSERT_EQ(oracle.method.step(Scheme::rk4, oracle.start(), h, next), Verdict::unique);
  EXPECT_NEAR(static_cast<double>(Real(next.v[0] / h)), 2.5, 1e-14);                // 0.1, 0.05, 0.3 are doubles
  EXPECT_LT(static_cast<double>(abs(Real(next.q[0] - h / 2 * next.v[0]))), 1e-45);  // the same in all stages
}

TEST(OracleMethodFriction, KeepsABlockAtRestWhereItIs) {
  Exact oracle(block(0.1, 0, 0.5, 0.5));  // 0.5 N against 1 N at least
  TreeState<Real> next;
  ASSERT_EQ(oracle.method.step(Scheme::rk4, oracle.start(), Real(0x1p-10), next), Verdict::unique);
  EXPECT_LT(size(next.q) + size(next.v), 1e-45);
}

/// A block, 1 kg, 1 m out on an arm that turns by t + t^2: friction, up to 24 N, holds it against 1 N. In later stages
/// its sliding speed is of the size of h^2, not zero; if that counted, all of the 24 N would act.
TEST(OracleMethodFriction, HoldsAGuideInAllStagesThatTheFirstHolds) {
  using slideway::Joint;
  const Real zero(0), one(1), mu(2);
  Model<Real> model;
  model.gravity = {zero, Real(-10)};
  model.alpha = Real(20);
  model.beta = Real(100);
  model.body = {{slideway::ground, Joint::revolute, {zero, zero}, {one, zero}, zero, one, {zero, zero}, one},
                {slideway::ground, Joint::planar, {zero, zero}, {one, zero}, zero, one, {zero, zero}, one}};
  model.guide = {{1, 0, {zero, zero}, {one, zero}, {{Real(-0.25), zero}, {Real(0.25), zero}}, mu, mu, zero, zero}};
  model.drive = {{0, 0, slideway::Law::polynomial, {zero, one, one}}};
  model.start = {{zero, one, zero, zero}, {one, zero, one, one}};
  Exact oracle(model);
  const Real h(0x1p-7), angle = h + h * h;
  TreeState<Real> next;
  ASSERT_EQ(oracle.method.step(Scheme::rk4, oracle.start(), h, next), Verdict::unique);
  const std::vector<Real> circle{angle, Real(cos(angle)), Real(sin(angle)), angle};
  EXPECT_LT(distance(next.q, circle), 1e-8);  // h^4 is 4e-9 (v' = 0 holds v to that order); 24 N make h^2 of it
}

/// The block slows at 1 m/s^2 and would turn back within the step. Frozen, friction goes on as it was.
TEST(OracleMethodFriction, IsFrozenWithinALocatedStep) {
  const Real h(0x1p-10), speed = h / 4;
  Exact oracle(block(0.1, 0x1p-12, 0.5, 0));
  for (const Scheme scheme : {Scheme::rk4_located, Scheme::dop853_located}) {
    TreeState<Real> next;
    ASSERT_EQ(oracle.method.step(scheme, oracle.start(), h, next), Verdict::unique);
    EXPECT_LT(distance(next.v, {Real(speed - h), Real(0), Real(0)}), 1e-18);  // 0.1 and 0.3 are doubles
  }
}

/// And by methods that do not locate the stop it is arrested at the step's end, and rests from then on. Pushed by more
/// than friction can hold, it turns back instead.
TEST(OracleMethodFriction, ArrestsABlockThatStopsWithinAStep) {
  const Real h(0x1p-10);
  for (const Scheme scheme : {Scheme::euler, Scheme::rk4}) {
    SCOPED_TRACE(name(scheme));
    TreeState<Real> next, later;
    Exact oracle(block(0.1, 0x1p-12, 0.5, 0));  // a quarter of what the step takes: rk4's stages cancel
    ASSERT_EQ(oracle.method.step(scheme, oracle.start(), h, next), Verdict::unique);
    EXPECT_LT(size(next.v), 1e-45);
    EXPECT_EQ(next.rests, std::vector<bool>{true});
    ASSERT_EQ(oracle.method.step(scheme, next, h, later), Verdict::unique);
    EXPECT_LT(distance(later.q, next.q), 1e-45);
    Exact pushed(block(0.1, 0x1p-12, 0.5, -1.5));
    ASSERT_EQ(pushed.method.step(scheme, pushed.start(), h, next), Verdict::unique);
    EXPECT_LT(next.v[0], 0);
    EXPECT_EQ(next.rests, std::vector<bool>{false});
  }
}

/// The kernel's projection after a step, from states off the constraints: its Newton steps end within 16 eps
/// (bodies + 1) of the largest distance, some metres here; speeds take as much of some tens of rad/s.
TEST(OracleMethodProjection, IsTheKernels) {
  for (const char* scene : {"squeezer", "four_bar_chain", "quick_return", "gantry"}) {
    SCOPED_TRACE(scene);
    const auto file = scene_file(scene);
    const auto stepper = std::make_unique<Stepper>(file.scene);
    stepper->stabilise = slideway::Stabilise::projection;
    Stepper::State state = stepper->start();
    for (int j = 0; j < stepper->source.tables.coordinates; ++j) state.q[j] += 1e-6 * (j + 1);
    const TreeState<Real> from = exact(*stepper, state);
    ASSERT_EQ(stepper->step(state, file.run.dt).status, Status::ok);
    Model<Real> ungained = model_of<Real>(file.scene);
    ungained.alpha = ungained.beta = Real(0);
    Exact projected(ungained);
    projected.method.projects = true;
    TreeState<Real> truth;
    ASSERT_EQ(projected.method.step(Scheme::rk4, from, Real(file.run.dt), truth), Verdict::unique);
    const double left = 16 * 0x1p-52 * (file.scene.bodies + 1);
    EXPECT_LE(distance(exact(*stepper, state).q, truth.q), 10 * left * size(truth.q));
    EXPECT_LE(distance(exact(*stepper, state).v, truth.v), 10 * left * size(truth.v));
    EXPECT_LT(projected.method.largest_drift(truth).position, 1e-29);
  }
}

/// A bead on a rod that turns at 1 rad/s, 1 m out: x'' = omega^2 x, all of it from the turning.
TEST(OracleMethodAcceleration, HasTheTermsOfMovingFrames) {
  using slideway::Joint;
  const Real zero(0), one(1);
  Model<Real> model;
  model.gravity = {zero, zero};
  model.alpha = model.beta = one;
  model.body = {{slideway::ground, Joint::revolute, {zero, zero}, {one, zero}, zero, one, {zero, zero}, one},
                {0, Joint::prismatic, {zero, zero}, {one, zero}, zero, one, {zero, zero}, one}};
  model.drive = {{0, 0, slideway::Law::uniform, {zero, one}}};
  model.start = {{zero, one}, {one, zero}};
  Exact oracle(model);
  std::vector<bool> held;
  std::vector<Real> a;
  ASSERT_EQ(oracle.method.accelerate(oracle.start(), held, a), Verdict::unique);
  EXPECT_LT(distance(a, {zero, one}), 1e-45);
}

/// Off the constraints by much more than rounding, pins between moving bodies and all.
TEST(OracleMethodDrift, IsWhatTheKernelReports) {
  for (const char* scene : {"squeezer", "four_bar_chain", "quick_return"}) {
    SCOPED_TRACE(scene);
    const auto file = scene_file(scene);
    const auto stepper = std::make_unique<Stepper>(file.scene);
    stepper->drift_limit = 1;
    Stepper::State state = stepper->start();
    for (int j = 0; j < stepper->source.tables.coordinates; ++j) {
      state.q[j] += 1e-4 * (j + 1);
      state.v[j] += 0.01 * (j + 2);
    }
    Stepper::Reaction reaction;
    const Report report = stepper->reaction(state, {}, reaction);
    ASSERT_EQ(report.status, Status::ok);
    Exact oracle(model_of<Real>(file.scene));
    const auto drift = oracle.method.largest_drift(exact(*stepper, state));
    EXPECT_GT(report.drift_position, 1e-6);
    EXPECT_NEAR(report.drift_position, static_cast<double>(drift.position), 1e-14);  // m: roundings of some metres
    EXPECT_NEAR(report.drift_velocity, static_cast<double>(drift.velocity), 1e-13);  // m/s: and of some tens of m/s
  }
}

/// Slipping to +x at height 0.3 over feet at +-0.05: W-property lost for mu >= 1/6; below 0.1 N m no answer, above two.
TEST(OracleMethodFriction, SaysWhyThereIsNoStep) {
  TreeState<Real> next;
  Exact impossible(block(0.2, 1, -0.2, 0)), ambiguous(block(0.2, 1, 0.5, 0));
  EXPECT_EQ(impossible.method.step(Scheme::euler, impossible.start(), Real(0x1p-10), next), Verdict::none);
  EXPECT_EQ(ambiguous.method.step(Scheme::rk4, ambiguous.start(), Real(0x1p-10), next), Verdict::several);
}

}  // namespace
