// Rows made orthonormal and the least change that they ask for; guides that are brought to rest by it.
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/step.hpp>

namespace {

using slideway::Joint;
using slideway::Scene;

// --- Basis -----------------------------------------------------------------------------------------------------------

/// Four coordinates, each of its own body of 1 kg, in one part.
using FourSize = slideway::Size<4, 4, 0, 0, 2, 0, 0, 0, 0, 0>;
using Four = slideway::RunTime<FourSize>;

Four four_coordinates() {
  Scene<FourSize> scene;
  scene.bodies = 4;
  for (int i = 0; i < 4; ++i) {
    scene.body[i].joint = Joint::prismatic;
    scene.body[i].mass = 1;
  }
  Four four(scene);
  four.tables.first_in_part[1] = 4;
  return four;
}

constexpr double rows[3][4] = {{1, 2, 0, 2}, {3, 1, 1, 0}, {1, -1, 4, 2}};
constexpr double right[3] = {3, -2, 7};
constexpr double rounding = 1e-14;  // some tens of roundings of numbers below 10

double dot(const double* a, const double* b) {
  double sum = 0;
  for (int j = 0; j < 4; ++j) sum += a[j] * b[j];
  return sum;
}

template <class Basis>
bool take(Basis& basis, const double* row, double value) {
  double* next = basis.next();
  for (int j = 0; j < 4; ++j) next[j] = row[j];
  return basis.take(0, std::sqrt(dot(row, row)), value);
}

/// The change meets the first `count` rows, and is one of their combinations: the shortest that does.
template <class Basis>
void expect_least_change(const Basis& basis, int count) {
  ASSERT_EQ(basis.count, count);
  for (int i = 0; i < count; ++i) EXPECT_NEAR(dot(rows[i], basis.change), right[i], rounding) << "row " << i;
  double rest[4];
  for (int j = 0; j < 4; ++j) rest[j] = basis.change[j];
  for (int i = 0; i < count; ++i) {
    const double part = dot(basis.Q[i], basis.change);
    for (int j = 0; j < 4; ++j) rest[j] -= part * basis.Q[i][j];
    for (int l = 0; l < count; ++l) EXPECT_NEAR(dot(basis.Q[i], basis.Q[l]), i == l ? 1 : 0, rounding);
  }
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(rest[j], 0, rounding);
}

TEST(Basis, HasTheLeastChangeThatItsRowsAskFor) {
  const Four source = four_coordinates();
  slideway::Basis<Four, 3> basis(source);
  expect_least_change(basis, 0);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(take(basis, rows[i], right[i]));
    expect_least_change(basis, i + 1);
  }
  for (int count = 2; count >= 0; --count) {
    basis.forget(count);
    expect_least_change(basis, count);
  }
}

TEST(Basis, TakesNoRowThatItHasAlready) {
  const Four source = four_coordinates();
  slideway::Basis<Four, 3> basis(source);
  ASSERT_TRUE(take(basis, rows[0], right[0]));
  ASSERT_TRUE(take(basis, rows[1], right[1]));
  double sum[4];
  for (int j = 0; j < 4; ++j) sum[j] = 2 * rows[0][j] - rows[1][j];
  EXPECT_FALSE(take(basis, sum, 1));
  expect_least_change(basis, 2);
  ASSERT_TRUE(take(basis, rows[2], right[2]));
  expect_least_change(basis, 3);
}

TEST(Basis, TakesNoMoreThanItHasRoomFor) {
  const Four source = four_coordinates();
  slideway::Basis<Four, 2> basis(source);
  ASSERT_TRUE(take(basis, rows[0], right[0]));
  ASSERT_TRUE(take(basis, rows[1], right[1]));
  EXPECT_FALSE(take(basis, rows[2], right[2]));
  expect_least_change(basis, 2);
}

// --- arrest ----------------------------------------------------------------------------------------------------------

/// A car of 1 kg on rails along x, and a block of 2 kg on it with a guide of its own along x; beside them a block of
/// 3 kg on the ground. All may be off their lines.
using CarSize = slideway::Size<3, 7, 2, 2, 2, 0, 0, 0, 0, 0>;
using Stepper = slideway::RunTimeStepper<CarSize>;

Stepper car_and_blocks() {
  Scene<CarSize> scene;
  scene.bodies = 3;
  scene.guides = 2;
  scene.body[0].joint = Joint::prismatic;
  scene.body[0].mass = 1;
  scene.body[1].parent = 0;
  scene.body[1].joint = Joint::planar;
  scene.body[1].mass = 2;
  scene.body[1].inertia = 1;
  scene.body[2].joint = Joint::planar;
  scene.body[2].mass = 3;
  scene.body[2].inertia = 1;
  scene.guide[0].slider = 1;
  scene.guide[0].rail = 0;
  scene.guide[1].slider = 2;
  for (slideway::Guide& guide : scene.guide) guide.mu = guide.mu_static = 0.5;
  return Stepper(scene);
}

struct Speeds {
  double q[7] = {0.3, 0.2, 0, 0, -0.4, 0, 0};
  double v[7] = {0.25, 0.5, 0, 0, -0.75, 0, 0};
};

bool arrest(const Stepper& stepper, const signed char (&held)[2], double most, const double* by, Speeds& s) {
  const Stepper::Inputs inputs{};
  return slideway::Projection<slideway::RunTime<CarSize>>(stepper.source, inputs, 0, s.q, s.v).arrest(held, most, by);
}

TEST(Arrest, BringsThoseGuidesToRestByTheLeastChangeAndLeavesTheOthersAlone) {
  const Stepper stepper = car_and_blocks();
  const double much[7] = {10, 10, 10, 10, 10, 10, 10};
  Speeds s;
  ASSERT_TRUE(arrest(stepper, {0, 1}, 1, much, s));
  // Momentum of car and block, 0.25 + 2 0.75 = 1.75, stays: 1.75 / 3 together.
  EXPECT_NEAR(s.v[0], 1.75 / 3, 1e-15);
  EXPECT_NEAR(s.v[1], 0, 1e-15);
  EXPECT_EQ(s.v[4], -0.75);
  Speeds other;
  ASSERT_TRUE(arrest(stepper, {1, 0}, 1, much, other));
  EXPECT_NEAR(other.v[0], 0.25, 1e-15);
  EXPECT_NEAR(other.v[1], 0.5, 1e-15);
  EXPECT_NEAR(other.v[4], 0, 1e-15);
  Speeds all;
  ASSERT_TRUE(arrest(stepper, {0, 0}, 1, much, all));
  EXPECT_NEAR(all.v[0], 1.75 / 3, 1e-15);
  EXPECT_NEAR(all.v[1], 0, 1e-15);
  EXPECT_NEAR(all.v[4], 0, 1e-15);
  for (int j = 0; j < 7; ++j) EXPECT_EQ(all.q[j], Speeds().q[j]);
}

TEST(Arrest, LeavesTheRatesOfConstraintsAsTheyAre) {
  // Off their lines, and on the way to them: both are Baumgarte's.
  const Stepper stepper = car_and_blocks();
  const double much[7] = {10, 10, 10, 10, 10, 10, 10};
  Speeds s;
  s.q[2] = 0.125;
  s.v[2] = -0.5;
  s.q[5] = -0.25;
  s.v[5] = 0.375;
  ASSERT_TRUE(arrest(stepper, {0, 0}, 1, much, s));
  EXPECT_NEAR(s.v[1], 0, 1e-15);
  EXPECT_NEAR(s.v[2], -0.5, 1e-15);
  EXPECT_NEAR(s.v[4], 0, 1e-15);
  EXPECT_NEAR(s.v[5], 0.375, 1e-15);
}

TEST(Arrest, IsNotMadeWhereItChangesMoreThanItMay) {
  // In the mass metric, whose squared length is twice the energy: the car gives and the block takes, 0.5 m/s against
  // each other with 2/3 kg of reduced mass.
  const Stepper stepper = car_and_blocks();
  const double change = std::sqrt(2.0 / 3) * 0.5;
  for (int k = 0; k < 16; ++k) {
    double by[7];
    Stepper::State state = stepper.start();
    for (int j = 0; j < 7; ++j) {
      state.q[j] = Speeds().q[j];
      by[j] = state.v[j] = std::cos(1.0 + k + 3 * j);
    }
    const double length = std::sqrt(2 * stepper.kinetic_energy(state));
    Speeds s;
    EXPECT_FALSE(arrest(stepper, {0, 1}, (1 - 1e-12) * change / length, by, s));
    for (int j = 0; j < 7; ++j) EXPECT_EQ(s.v[j], Speeds().v[j]);
    EXPECT_TRUE(arrest(stepper, {0, 1}, (1 + 1e-12) * change / length, by, s));
    EXPECT_NEAR(s.v[1], 0, 1e-15);
  }
}

}  // namespace
