// Where events are found, and what that costs, for functions of time that are known: a block that rests on a carriage
// breaks away when the carriage's acceleration passes mu g, and that is a polynomial.
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/step.hpp>
#include <vector>

namespace {

using slideway::EventKind;
using slideway::Joint;
using slideway::Law;
using slideway::Method;
using slideway::Report;
using slideway::Scene;
using slideway::Status;

constexpr Method located[] = {Method::rk4_located, Method::dop853_located};

using Size = slideway::Size<2, 4, 2, 2, 2, 0, 0, 0, 0, 0>;
using Stepper = slideway::RunTimeStepper<Size>;

constexpr double limit = 5;  // m/s^2, mu g

/// The carriage's acceleration is limit + sum p_k t^k, with at most six terms.
Stepper on_carriage(const std::vector<double>& p, Method method) {
  Scene<Size> scene;
  scene.gravity = {0, -10};
  scene.alpha = scene.beta = 0;  // the law is followed but for the method's error in places, which act on nothing
  scene.bodies = 2;
  scene.guides = scene.drives = 1;
  scene.body[0].joint = Joint::prismatic;
  scene.body[0].mass = 1;
  scene.body[1].joint = Joint::planar;
  scene.body[1].mass = scene.body[1].inertia = 1;
  scene.guide[0].slider = 1;
  scene.guide[0].rail = 0;
  scene.guide[0].mu = scene.guide[0].mu_static = 0.5;
  scene.drive[0].law = Law::polynomial;
  scene.drive[0].terms = static_cast<int>(p.size()) + 2;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double a = p[k] + (k == 0 ? limit : 0);
    scene.drive[0].c[k + 2] = a / static_cast<double>((k + 1) * (k + 2));
  }
  Stepper stepper(scene);
  stepper.method = method;
  return stepper;
}

/// peak - scale (t - where)^power, by its coefficients.
std::vector<double> around(double where, double peak, double scale, int power) {
  std::vector<double> p(static_cast<std::size_t>(power) + 1);
  double binomial = 1;
  for (int k = power; k >= 0; --k) {  // (t - w)^n = sum C(n, k) t^k (-w)^(n-k)
    p[static_cast<std::size_t>(k)] = -scale * binomial * std::pow(-where, power - k);
    binomial = binomial * k / (power - k + 1);
  }
  p[0] += peak;
  return p;
}

/// One step of 1 s from rest.
Report step_of_a_second(Method method, const std::vector<double>& p) {
  const Stepper stepper = on_carriage(p, method);
  auto state = stepper.start();
  const Report report = stepper.step(state, 1);
  EXPECT_EQ(report.status, Status::ok) << name(method) << ": " << sentence(report.status);
  return report;
}

/// The limit is passed for a moment around `where`, and the block slips; it stays behind, and sticks again.
void expect_slip_and_stick(Method method, const Report& report, double slip, double tolerance) {
  ASSERT_EQ(report.events, 2) << name(method);
  EXPECT_EQ(report.event[0].kind, EventKind::slip) << name(method);
  EXPECT_NEAR(report.event[0].t, slip, tolerance) << name(method);
  EXPECT_EQ(report.event[1].kind, EventKind::stick) << name(method);
}

TEST(AMomentBeyondTheLimit, IsFoundBetweenTheStages) {
  // At 0.37 s, where no stage is: all of them are within the limit, by 0.05 m/s^2 and more. A parabola tells where the
  // limit is passed, for it is one: 0.02 m/s^2 over it at the most, for 0.07 s to both sides. The block is
  // 0.02 s - 4/3 s^3 slower since then, s counted from the peak, which is nothing again after twice that.
  for (const Method method : located) {
    const Report report = step_of_a_second(method, around(0.37, 0.02, 4, 2));
    const double half = std::sqrt(0.02 / 4);
    expect_slip_and_stick(method, report, 0.37 - half, 1e-12);  // s; eps times 5 m/s^2 over a slope of 0.6 m/s^3
    EXPECT_NEAR(report.event[1].t, 0.37 + 2 * half, 1e-12) << name(method);
  }
}

TEST(AMomentBeyondTheLimit, IsFoundAtTheStageThatSeesIt) {
  // 1e-8 m/s^2 beyond it, for 7 ms to both sides of a stage, where parabolas do not lead: the limit is approached with
  // the fourth power of the time.
  const double half = std::pow(1e-8 / 4, 0.25);
  // s; some eps times 5 m/s^2, over a slope of 16 half^3 = 5.7e-6 m/s^3.
  const double tolerance = 1e-8;
  for (const Method method : located) {
    expect_slip_and_stick(method, step_of_a_second(method, around(0.5, 1e-8, 4, 4)), 0.5 - half, tolerance);
  }
  expect_slip_and_stick(Method::dop853_located, step_of_a_second(Method::dop853_located, around(0.6, 1e-8, 4, 4)),
                        0.6 - half, tolerance);
}

TEST(AnEventTime, IsThatOfAZeroOfAnyOrderToItsRounding) {
  // 4 (t - t0)^n passes the rounding of the limit, some eps of 5 m/s^2, within (eps 5 / 4)^(1/n) s or a few of it.
  for (const Method method : located) {
    for (const int power : {1, 3, 5}) {
      for (const double where : {0.37, 0.77}) {
        const Report report = step_of_a_second(method, around(where, 0, -4, power));
        ASSERT_EQ(report.events, 1) << name(method) << ", order " << power;
        EXPECT_EQ(report.event[0].kind, EventKind::slip);
        EXPECT_NEAR(report.event[0].t, where, std::pow(16 * 0x1p-52 * 5 / 4, 1.0 / power))
            << name(method) << ", order " << power;
      }
    }
  }
}

TEST(AnEvent, CostsFewProbesWhereFunctionsAreSmooth) {
  // Six to the zero, since interpolation by three points gains digits by 1.8 each time; 13 by which the other end of
  // the bracket comes near, by a sixteenth each; six more, since every third may halve it instead. A probe is a step
  // and a look at its end. What is left are the first look, the search, and the steps between the events.
  for (const Method method : located) {
    const int stages = method == Method::rk4_located ? 4 : 12;
    const Report report = step_of_a_second(method, around(0.37, 0.02, 4, 2));
    ASSERT_EQ(report.events, 2);
    EXPECT_LE(report.evaluations, (2 * (6 + 13 + 6) + 4) * stages) << name(method);
  }
}

}  // namespace
