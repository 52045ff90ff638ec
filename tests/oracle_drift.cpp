// How far methods drift off the constraints: linear limits, and bounds against what the kernel does.
#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <slideway/io/scene_file.hpp>
#include <slideway/io/stepper.hpp>
#include <slideway/oracle/drift.hpp>
#include <string>

namespace {

using slideway::Report;
using slideway::Status;
using slideway::oracle::Drift;
using slideway::oracle::drift_bound;
using slideway::oracle::drift_map;
using slideway::oracle::DriftBound;
using slideway::oracle::FrictionLaw;
using slideway::oracle::Integrator;
using slideway::oracle::largest_stable_step;
using slideway::oracle::lyapunov_matrix;
using slideway::oracle::Map;
using slideway::oracle::Method;
using slideway::oracle::Model;
using slideway::oracle::model_of;
using slideway::oracle::propagation;
using slideway::oracle::Real;
using slideway::oracle::runge_kutta_map;
using slideway::oracle::Scheme;
using slideway::oracle::semi_implicit_map;
using slideway::oracle::spectral_radius;
using slideway::oracle::TreeState;
using Stepper = slideway::RunTimeStepper<slideway::io::RunSize>;

Real runge_kutta_limit(int order, double alpha, double beta) {
  return largest_stable_step<Real>([&](const Real& h) { return runge_kutta_map(order, h, Real(alpha), Real(beta)); },
                                   Real(0.01) / (1 + alpha));
}

Real semi_implicit_limit(double alpha, double beta) {
  return largest_stable_step<Real>([&](const Real& h) { return semi_implicit_map(h, Real(alpha), Real(beta)); },
                                   Real(0.01) / (1 + alpha));
}

/// Literature's limits of |h lambda| on the negative real axis (Hairer and Wanner 1996, IV.2), which critical damping
/// meets with both eigenvalues, and of rk4 on the imaginary one, sqrt(8).
TEST(OracleDriftLimits, OfRungeKuttaMethods) {
  const double exact[] = {2, 2, 2.51274532661832862, 2.7852935634052816};
  for (int order = 1; order <= 4; ++order) {
    // 1e-15: the digits given, and a double's
    EXPECT_NEAR(static_cast<double>(runge_kutta_limit(order, 2, 1)), exact[order - 1], 1e-15) << order;
  }
  EXPECT_NEAR(static_cast<double>(runge_kutta_limit(4, 0, 1)), 2.8284271247461901, 1e-15);
  EXPECT_EQ(runge_kutta_limit(2, 0, 1), 0);  // unstable at any step
}

TEST(OracleDriftLimits, OfGains) {
  struct Row {
    double alpha, beta, euler, rk4, semi_implicit;
  };
  for (const Row& row : {Row{10, 25, 0.4, 0.5570587127, 0.165685425}, Row{20, 100, 0.2, 0.2785293563, 0.0828427125},
                         Row{5, 100, 0.05, 0.2896697371, 0.156155281}}) {
    EXPECT_NEAR(static_cast<double>(runge_kutta_limit(1, row.alpha, row.beta)), row.euler, 1e-15);
    EXPECT_NEAR(static_cast<double>(runge_kutta_limit(4, row.alpha, row.beta)), row.rk4, 5.1e-11);
    EXPECT_NEAR(static_cast<double>(semi_implicit_limit(row.alpha, row.beta)), row.semi_implicit, 5.1e-10);
  }
}

/// Coefficients and stages give the polynomial that order and stages do; DOP853, with four stages more than orders, the
/// exponential's to the eighth power of h A: 29 digits of coefficients are left of the first eight.
TEST(OracleDriftLimits, OfAMethodsCoefficients) {
  const Real alpha(2), beta(3);
  const auto entry = [](const Map<Real>& R) { return Real(abs(R(0, 0)) + abs(R(0, 1)) + abs(R(1, 0)) + abs(R(1, 1))); };
  const auto off = [&](Scheme scheme, int order, const Real& h) {
    return entry(Map<Real>(drift_map(scheme, h, alpha, beta) - runge_kutta_map(order, h, alpha, beta)));
  };
  EXPECT_LT(off(Scheme::rk4, 4, Real(1)), Real(1e-45));
  EXPECT_LT(off(Scheme::rk4_located, 4, Real(1)), Real(1e-45));
  EXPECT_NEAR(
      static_cast<double>(off(Scheme::dop853_located, 8, Real(0x1p-6)) / off(Scheme::dop853_located, 8, Real(0x1p-7))),
      512, 30);
}

TEST(OracleDriftBound, GrowsAsItMustWithoutGains) {
  const Real h(0x1p-7);
  for (const Map<Real>& R : {runge_kutta_map(4, h, Real(0), Real(0)), semi_implicit_map(h, Real(0), Real(0))}) {
    const auto p = propagation(R, 100);
    EXPECT_EQ(p.sum(0, 0), 100);
    EXPECT_EQ(p.sum(1, 1), 100);
    EXPECT_EQ(p.sum(1, 0), 0);
    EXPECT_EQ(p.sum(0, 1), h * (100 * 99 / 2));
    EXPECT_EQ(p.peak(0, 1), h * 100);
  }
}

/// Sums over all powers, cut short, against ten thousand of them added up; and against the weaker bound in a norm.
TEST(OracleDriftBound, IsOfAllSteps) {
  const Real h(0.01), alpha(20), beta(100);
  for (const Map<Real>& R : {runge_kutta_map(4, h, alpha, beta), semi_implicit_map(h, alpha, beta)}) {
    Map<Real> sum = Map<Real>::Zero(), power = Map<Real>::Identity();
    for (int k = 0; k < 10000; ++k, power = (power * R).eval()) sum += power.cwiseAbs();
    const auto p = propagation(R, 1000000);
    for (int i = 0; i < 4; ++i) {
      EXPECT_GE(p.sum(i), sum(i));
      EXPECT_LE(p.sum(i), sum(i) * (1 + 0x1p-16)) << i;  // cut where |R^m| is 2^-20
    }
    const Drift<Real> start{Real(1e-9), Real(1e-8)}, defect{Real(1e-10), Real(1e-8)};
    const auto in_norm = norm_bound(R, beta, start, defect);
    EXPECT_LT(in_norm.rho, 1);
    EXPECT_GT(in_norm.rho, spectral_radius(R));
    EXPECT_GT(in_norm.bound.position, p.peak(0, 0) * start.position + p.sum(0, 0) * defect.position +
                                          p.peak(0, 1) * start.velocity + p.sum(0, 1) * defect.velocity);
  }
}

/// In its norm R shrinks every direction by rho at least.
TEST(OracleDriftBound, HasANormThatContracts) {
  const Real beta(100);
  const Map<Real> R = runge_kutta_map(4, Real(0.01), Real(20), beta);
  const Real rho = (1 + spectral_radius(R)) / 2;
  const Map<Real> P = lyapunov_matrix(R, rho, beta);
  for (int degrees = 0; degrees < 180; degrees += 5) {
    const Real turn = Real(degrees) / 57;
    const Eigen::Matrix<Real, 2, 1> e(Real(cos(turn)), Real(10 * sin(turn))), f = R * e;
    EXPECT_GT(e.dot(P * e), 0);
    EXPECT_LT(f.dot(P * f), rho * rho * e.dot(P * e));
  }
}

/// A scene's motion, and what the kernel's steps make of it.
class Motion {
 public:
  /// `duration`, s: of what is sampled; a period, if the motion has one.
  Motion(const std::string& name, double duration) {
    auto reading = slideway::io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml");
    EXPECT_TRUE(reading.scene);
    if (!reading.scene) return;
    file_ = *reading.scene;
    model = model_of<Real>(file_.scene);
    Integrator<Real> integrator(model, {});
    const auto run = integrator.run(Real(duration), {});
    EXPECT_EQ(run.end, slideway::oracle::End::duration);
    events_ = run.events;
    duration_ = duration;
  }

  double dt() const { return file_.run.dt; }
  double duration() const { return file_.run.duration; }
  Model<Real> model;

  std::vector<TreeState<Real>> samples(double h, int count) const {
    Integrator<Real> integrator(model, {});
    std::vector<TreeState<Real>> states;
    for (const auto& at :
         integrator.run(Real(duration_), sample_times(events_, Real(h), Real(duration_), count)).samples) {
      states.push_back({at.t, at.q, at.v});
    }
    return states;
  }

  /// With the model's gains.
  DriftBound<Real> bound(Scheme scheme, double h, long steps, const std::vector<TreeState<Real>>& states) const {
    slideway::oracle::Dynamics<Real> dynamics(model, FrictionLaw<Real>::orders);
    FrictionLaw<Real> law(dynamics);
    Method<Real> method(dynamics, law);
    const auto found = drift_bound(method, scheme, Real(h), steps, {Real(0), model.start.q, model.start.v}, states);
    EXPECT_TRUE(found);
    return found.value_or(DriftBound<Real>{});
  }

  /// Largest drift of a run of the kernel, up to its refusal if it refuses; `steps` made.
  Drift<double> measured(Scheme scheme, double h, double alpha, double beta, long& steps) const {
    const auto stepper = std::make_unique<Stepper>(file_.scene);
    stepper->method = method_of(scheme);
    stepper->gains = {alpha, beta};
    stepper->drift_limit = 1;
    Stepper::State state = stepper->start();
    Drift<double> most{0, 0};
    for (long k = 0; k < steps; ++k) {
      const Report report = stepper->step(state, h);
      if (report.status == Status::drift_limit) most.position = 1;
      if (report.status != Status::ok) {
        steps = k;
        break;
      }
      most = {std::max(most.position, report.drift_position), std::max(most.velocity, report.drift_velocity)};
    }
    return most;
  }

 private:
  slideway::io::SceneFile file_;
  std::vector<slideway::oracle::TrajectoryEvent<Real>> events_;
  double duration_ = 0;
};

struct Case {
  const char* scene;
  double sampled;  ///< s: a turn
  bool drifts;     ///< by more than rounding
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }

class OracleDrift : public testing::TestWithParam<Case> {};

TEST_P(OracleDrift, BoundsWhatTheKernelDoes) {
  const Motion motion(GetParam().scene, GetParam().sampled);
  const double alpha = static_cast<double>(motion.model.alpha), beta = static_cast<double>(motion.model.beta);
  for (const double h : {motion.dt(), 10 * motion.dt()}) {
    const auto samples = motion.samples(h, 12);
    for (const Scheme scheme : {Scheme::rk4, Scheme::euler, Scheme::dop853_located}) {
      const std::string what = std::string(name(scheme)) + "_" + testing::PrintToString(h);
      SCOPED_TRACE(what);
      long steps = std::lround(motion.duration() / h);
      const Drift<double> measured = motion.measured(scheme, h, alpha, beta, steps);
      EXPECT_GT(steps, 50);  // it went on until the bound is nearly that of all steps
      const DriftBound<Real> found = motion.bound(scheme, h, steps, samples);
      ASSERT_TRUE(found.stable);
      const double position = static_cast<double>(found.bound.position) / measured.position;
      const double velocity = static_cast<double>(found.bound.velocity) / measured.velocity;
      EXPECT_GT(position, 1);
      EXPECT_GT(velocity, 1);
      if (GetParam().drifts && scheme != Scheme::dop853_located) {
        EXPECT_LT(position, 100);
        EXPECT_LT(velocity, 100);
      } else {  // what could have been rounding, in hundreds of steps
        EXPECT_LT(found.bound.position, 1e-10);
        EXPECT_LT(found.bound.velocity, 1e-9);
      }
      RecordProperty(what + "_position_ratio", testing::PrintToString(position));
      RecordProperty(what + "_velocity_ratio", testing::PrintToString(velocity));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OracleDrift,
                         testing::Values(Case{"crank_rocker", 2.0943951023931955, true},
                                         Case{"slider_crank_driven", 0.62831853071795865, true},
                                         Case{"four_bar_chain", 1, false}, Case{"elliptic_trammel", 1.2, true},
                                         Case{"quick_return", 1.0471975511965977, true}),
                         [](const auto& test) { return std::string(test.param.scene); });

/// Gains against drift over 20 s of the crank-rocker with rk4: the largest are worse than none.
TEST(OracleDriftGains, BoundTheCrankRocker) {
  Motion motion("crank_rocker", 2.0943951023931955);
  const double h = 0.01;
  const auto samples = motion.samples(h, 24);
  struct Row {
    double alpha, beta, published;  ///< m
  };
  for (const Row& row : {Row{0, 0, 9.7e-7}, Row{10, 25, 5.21e-8}, Row{20, 100, 1.86e-7}, Row{50, 625, 8.55e-7},
                         Row{100, 2500, 3.29e-6}}) {
    SCOPED_TRACE(row.alpha);
    motion.model.alpha = Real(row.alpha);
    motion.model.beta = Real(row.beta);
    long steps = 2000;
    const double measured = motion.measured(Scheme::rk4, h, row.alpha, row.beta, steps).position;
    ASSERT_EQ(steps, 2000);
    EXPECT_NEAR(measured, row.published, 0.006 * row.published);  // three digits, or two
    const DriftBound<Real> found = motion.bound(Scheme::rk4, h, steps, samples);
    EXPECT_EQ(found.stable, row.alpha > 0);
    EXPECT_GT(found.bound.position, measured);
    EXPECT_LT(found.bound.position, (row.alpha > 0 ? 100 : 1e5) * measured);
    RecordProperty("alpha_" + testing::PrintToString(row.alpha),
                   testing::PrintToString(static_cast<double>(found.bound.position) / measured));
  }
}

/// A kernel with a wrong sign among its Baumgarte terms is found out by the bound of the right one.
TEST(OracleDriftGains, ExposeAWrongSign) {
  const Motion motion("crank_rocker", 2.0943951023931955);
  const double h = 0.01, alpha = 20, beta = 100;
  const double bound = static_cast<double>(motion.bound(Scheme::rk4, h, 2000, motion.samples(h, 24)).bound.position);
  long right = 2000, wrong_rate = 2000, wrong_value = 2000;
  EXPECT_LT(motion.measured(Scheme::rk4, h, alpha, beta, right).position, bound);
  EXPECT_GT(motion.measured(Scheme::rk4, h, -alpha, beta, wrong_rate).position, bound);
  EXPECT_GT(motion.measured(Scheme::rk4, h, alpha, -beta, wrong_value).position, bound);
}

}  // namespace
