// The self-check: it lets right answers pass whatever their rows' scales, and no others.
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/step.hpp>

namespace {

using slideway::Joint;
using slideway::Method;
using slideway::Scene;
using slideway::Status;

// --- wrong answers ---------------------------------------------------------------------------------------------------

/// A block of 1 kg that slides at 1 m/s on two feet and leans on them: one guide with two contacts.
using BlockSize = slideway::Size<2, 6, 2, 4, 2, 0, 0, 0, 0, 0>;
using Block = slideway::RunTime<BlockSize>;

Block leaning_block() {
  Scene<BlockSize> scene;
  scene.gravity = {0, -10};
  scene.bodies = scene.guides = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = 1;
  scene.body[0].inertia = 0.25;
  scene.body[0].com = {0.125, 0.25};
  scene.body[0].v[0] = 1;
  scene.guide[0].contacts = 2;
  scene.guide[0].contact[0] = {-0.25, 0};
  scene.guide[0].contact[1] = {0.5, 0};
  scene.guide[0].mu = scene.guide[0].mu_static = 0.25;
  return Block(scene);
}

/// All that comes before the contact forces, as acceleration.hpp has it, for guides that slip.
struct Instant {
  Block source = leaning_block();
  slideway::Work<BlockSize> w{};
  slideway::Reaction<BlockSize> r{};
  slideway::Problem<Block> hlcp{};

  Instant() {
    const slideway::Body& body = source.scene.body[0];
    const slideway::Inputs<BlockSize> inputs{};
    const slideway::Solving solving{};
    const signed char mode[1] = {1};
    const slideway::Moment<BlockSize> at{0, 0, body.q, body.v, inputs, slideway::Aim::decide, true};
    place(source, at, solving, w, r);
    apply_forces(source, w.kinematics, inputs, 0, w.dynamics);
    apply_steady_friction(source, mode, w.friction, w.dynamics);
    gather(source, w.kinematics, w.dynamics);
    EXPECT_TRUE(factor_mass(source, w.kinematics, body.q, body.v, w.dynamics));
    EXPECT_TRUE(assemble(source, w.kinematics, w.dynamics, solving.gains, mode, w.friction, r));
    EXPECT_TRUE(assemble_part(source, w.kinematics, w.dynamics, 0, w.friction, hlcp));
  }

  /// With these contact forces, and the accelerations that they give.
  double residual(double lambda_0, double lambda_1) {
    r.lambda[0] = lambda_0;
    r.lambda[1] = lambda_1;
    for (int c = 0; c < 2; ++c) w.friction.face[c] = r.lambda[c] < 0 ? -1 : 1;
    resolve(source, r, w);
    from_metric(source, w.dynamics, w.u);
    for (int j = 0; j < 3; ++j) r.acceleration[j] = w.u[source.tables.free_of[j]];
    return check(source, w, r);
  }
};

TEST(SelfCheck, RefusesForcesThatLetOneContactLeaveItsLine) {
  Instant instant;
  // By hand: N0 + N1 = 10 N, friction -2.5 N; moments about the centre of mass at (1/8, 1/4) m:
  // -3/8 N0 + 3/8 N1 - 1/4 2.5 = 0.
  const double lambda[2] = {5 - 2.5 / 3, 5 + 2.5 / 3};
  const double bound = residual_bound(instant.source);
  EXPECT_LE(instant.residual(lambda[0], lambda[1]), bound);
  // Changes that leave one contact's acceleration as it is, by a column of the HLCP's matrix; 2^-30 of the force.
  const auto& A = instant.hlcp.plus;
  for (const double size : {0x1p-30, -0x1p-30, 1.0, -1.0}) {
    for (const int stays : {0, 1}) {
      const double change[2] = {-A[stays][1] * size, A[stays][0] * size};
      const double residual = instant.residual(lambda[0] + change[0], lambda[1] + change[1]);
      EXPECT_GT(residual, bound) << "contact " << stays << " stays, " << size;
    }
  }
}

TEST(SelfCheck, RefusesAccelerationsThatTheForcesDoNotGive) {
  Instant instant;
  const double lambda[2] = {5 - 2.5 / 3, 5 + 2.5 / 3}, bound = residual_bound(instant.source);
  for (int j = 0; j < 3; ++j) {
    ASSERT_LE(instant.residual(lambda[0], lambda[1]), bound);
    instant.r.acceleration[j] += 0x1p-30;
    EXPECT_GT(check(instant.source, instant.w, instant.r), bound) << "coordinate " << j;
  }
}

// --- right answers ---------------------------------------------------------------------------------------------------

/// A body of 1 kg, off its centre, on a pin to a car that slides along x or y and weighs next to nothing; the car is
/// pushed.
using CarSize = slideway::Size<2, 4, 2, 2, 2, 2, 0, 0, 2, 0>;

Scene<CarSize> body_on_light_car(double mass, bool upright) {
  Scene<CarSize> scene;
  scene.gravity = {3, -7};
  scene.bodies = 2;
  scene.pins = scene.loads = 1;
  scene.load[0].force = {5, 4};
  scene.body[0].joint = Joint::prismatic;
  if (upright) {
    scene.body[0].angle = 0.5 * 3.14159265358979323846;
    scene.body[0].turn = {0, 1};
  }
  scene.body[0].mass = mass;
  scene.body[1].joint = Joint::planar;
  scene.body[1].mass = 1;
  scene.body[1].inertia = 0.3;
  scene.body[1].com = {0.7, 0.1};
  scene.body[1].q[2] = 0.4;
  scene.body[1].v[2] = 1.3;
  scene.pin[0].a = 1;
  scene.pin[0].b = 0;
  return scene;
}

TEST(SelfCheck, MeasuresEachRowOfAPinByItsOwnRounding) {
  // The car's 1e-8 kg make one row of the pin 1e4 times as long as the other, and what rounding makes of the push.
  for (const bool upright : {false, true}) {
    slideway::RunTimeStepper<CarSize> stepper(body_on_light_car(1e-8, upright));
    stepper.method = Method::rk4;
    auto state = stepper.start();
    for (int k = 0; k < 200; ++k) {
      const slideway::Report report = stepper.step(state, 0x1p-8);
      ASSERT_EQ(report.status, Status::ok) << sentence(report.status) << " at " << state.time() << " s";
    }
  }
}

}  // namespace
