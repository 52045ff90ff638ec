// What scene.hpp, structure.hpp, state.hpp, step.hpp and method.hpp promise in a word or two, at the edge of it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <slideway/step.hpp>
#include <string>

namespace {

using slideway::Body;
using slideway::Defect;
using slideway::defects;
using slideway::Drive;
using slideway::Findings;
using slideway::ground;
using slideway::Item;
using slideway::Joint;
using slideway::Method;
using slideway::Scene;
using slideway::Status;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

using Room = slideway::Size<2, 6, 2, 4, 2, 2, 2, 2, 1, 0>;
using Stepper = slideway::RunTimeStepper<Room>;

/// Two bodies on the ground, free in the plane.
Scene<Room> two_bodies() {
  Scene<Room> scene;
  scene.bodies = 2;
  for (int i = 0; i < 2; ++i) {
    scene.body[i].joint = Joint::planar;
    scene.body[i].mass = scene.body[i].inertia = 1.0;
  }
  return scene;
}

/// The defect is the only one, and told of the item and its number.
void expect_one(const Scene<Room>& scene, Item item, int index, Defect defect) {
  const Findings found = defects(scene);
  ASSERT_EQ(found.count, 1);
  EXPECT_EQ(found.finding[0].item, item);
  EXPECT_EQ(found.finding[0].index, index);
  EXPECT_EQ(found.finding[0].defect, defect) << sentence(found.finding[0].defect);
}

// ---- scene.hpp

TEST(Contracts, APinIsAtFinitePlaces) {
  Scene<Room> scene = two_bodies();
  scene.pins = 2;
  for (int p = 0; p < 2; ++p) {
    scene.pin[p].a = p;
    ASSERT_EQ(defects(scene).count, 0);
    for (double* place : {&scene.pin[p].a_at.x, &scene.pin[p].a_at.y, &scene.pin[p].b_at.x, &scene.pin[p].b_at.y})
      for (const double bad : {nan_value, infinity}) {
        *place = bad;
        expect_one(scene, Item::pin, p, Defect::not_finite);
        *place = 0.0;
      }
  }
}

TEST(Contracts, ASpringOfNoStiffnessLengthOrDampingIsNoDefect) {
  Scene<Room> scene = two_bodies();
  scene.body[1].joint = Joint::revolute;
  scene.springs = scene.joint_springs = 1;
  scene.joint_spring[0].body = 1;
  EXPECT_EQ(defects(scene).count, 0);
  const auto expect_none_below_zero = [&](double& value, Item item, Defect defect) {
    value = -std::numeric_limits<double>::denorm_min();
    expect_one(scene, item, 0, defect);
    value = 0.0;
  };
  expect_none_below_zero(scene.spring[0].stiffness, Item::spring, Defect::negative_stiffness);
  expect_none_below_zero(scene.spring[0].length, Item::spring, Defect::negative_length);
  expect_none_below_zero(scene.spring[0].damping, Item::spring, Defect::negative_damping);
  expect_none_below_zero(scene.joint_spring[0].stiffness, Item::joint_spring, Defect::negative_stiffness);
  expect_none_below_zero(scene.joint_spring[0].damping, Item::joint_spring, Defect::negative_damping);
}

TEST(Contracts, ACoordinateIsDrivenOnce) {
  Scene<Room> scene = two_bodies();
  scene.drives = 2;
  const auto drive = [&](int body, int axis, int other_body, int other_axis) {
    scene.drive[0].body = body;
    scene.drive[0].axis = axis;
    scene.drive[1].body = other_body;
    scene.drive[1].axis = other_axis;
  };
  drive(0, 0, 0, 1);
  EXPECT_EQ(defects(scene).count, 0) << "two axes of one body";
  drive(0, 1, 1, 1);
  EXPECT_EQ(defects(scene).count, 0) << "one axis of two bodies";
  drive(1, 2, 1, 2);
  expect_one(scene, Item::drive, 1, Defect::driven_twice);
}

TEST(Contracts, FindingsBeyondTheRoomAreCountedNotKept) {
  Findings found;
  const int more = Findings::room + 3;
  for (int k = 0; k < more; ++k) found.add(Item::load, k, Defect::no_such_input);
  EXPECT_EQ(found.count, more);
  for (int k = 0; k < Findings::room; ++k) {
    EXPECT_EQ(found.finding[k].item, Item::load);
    EXPECT_EQ(found.finding[k].index, k);
    EXPECT_EQ(found.finding[k].defect, Defect::no_such_input);
  }
}

// ---- structure.hpp

TEST(Contracts, TheLengthIsTheLargestDistanceInAnyUnit) {
  // rough_sqrt() is good to 1e-3, relative: accuracy enough for a scale.
  const double accuracy = 1e-3;
  const auto length = [](double size, int where) {
    Scene<Room> scene = two_bodies();
    scene.pins = 1;
    const slideway::Vec2 at = {0.6 * size, 0.8 * size};
    (where == 0 ? scene.pin[0].a_at : where == 1 ? scene.pin[0].b_at : scene.body[0].com) = at;
    return derive(scene).length;
  };
  for (int where = 0; where < 3; ++where) {
    const double decimetre = length(0.1, where);
    EXPECT_NEAR(decimetre, 0.1, accuracy * 0.1);
    for (double size = 1.0; size < 4.0; size *= 1.01) EXPECT_NEAR(length(size, where), size, accuracy * size);
    // The same scene in units 1024 times smaller: its numbers are 1024 times as large, and no rounding changes.
    EXPECT_EQ(length(1024 * 0.1, where), 1024 * decimetre);
    EXPECT_EQ(length(0.1 / 1024, where), decimetre / 1024);
  }
  EXPECT_EQ(length(0.0, 0), 1.0) << "of a scene without any";
  EXPECT_GT(length(1e-155, 0), 0.0) << "whose square is subnormal";
}

TEST(Contracts, MassIsOffCentreOnlyWhereItHasAnArm) {
  // A body on a body, both centred in their joints. It has an arm where its joint is elsewhere, or slides.
  const auto off_centre = [](Joint joint, double at) {
    Scene<Room> scene = two_bodies();
    scene.body[1].parent = 0;
    scene.body[1].joint = joint;
    scene.body[1].at.x = at;
    return derive(scene).off_centre[0];
  };
  EXPECT_FALSE(off_centre(Joint::revolute, 0.0));
  EXPECT_FALSE(off_centre(Joint::fixed, 0.0));
  EXPECT_TRUE(off_centre(Joint::prismatic, 0.0));
  EXPECT_TRUE(off_centre(Joint::planar, 0.0));
  EXPECT_TRUE(off_centre(Joint::revolute, 1.0));
  EXPECT_TRUE(off_centre(Joint::fixed, 1.0));
}

TEST(Contracts, ADirectionMayPointAnywhere) {
  Scene<Room> scene = two_bodies();
  scene.guides = 1;
  for (int k = 0; k < 64; ++k) {
    const double angle = 3.14159265358979323846 * k / 32;
    for (const double size : {1.0, 1e-9, 1e9}) {
      scene.guide[0].tangent = {std::cos(angle), std::sin(angle)};
      scene.guide[0].direction = {size * scene.guide[0].tangent.x, size * scene.guide[0].tangent.y};
      EXPECT_EQ(defects(scene).count, 0) << angle;
      scene.guide[0].direction = {-scene.guide[0].direction.x, -scene.guide[0].direction.y};
      expect_one(scene, Item::guide, 0, Defect::tangent_not_unit);
    }
  }
  scene.guide[0] = {};
  EXPECT_EQ(defects(scene).count, 0) << "the default";
}

// ---- friction.hpp

TEST(Contracts, ContactsAreIndependentWhereNoRoundingCouldMakeThemSo) {
  // Rows (1, 0) and (1, d): S = [1, 1; 1, 1 + d d], exact. A pivot is off by 2 eps at most; 24 eps are far above that.
  slideway::Hlcp<2> problem{};
  const auto independent = [&](double pivot) {
    for (auto* matrix : {&problem.plus, &problem.minus}) {
      (*matrix)[0][0] = (*matrix)[0][1] = (*matrix)[1][0] = 1;
      (*matrix)[1][1] = 1 + pivot;
    }
    return independent_contacts(problem, 2);
  };
  EXPECT_TRUE(independent(24 * 0x1p-52));
  EXPECT_TRUE(independent(1));
  EXPECT_FALSE(independent(0));
  EXPECT_FALSE(independent(2 * 0x1p-52));
}

TEST(Contracts, ContactForcesHaveTheDigitsOfTheMatrixOfTheirSigns) {
  slideway::Hlcp<2> problem{};
  problem.plus[0][0] = problem.plus[1][1] = 1;
  problem.minus[0][0] = problem.minus[0][1] = problem.minus[1][0] = 1;
  problem.minus[1][1] = 1 + 0x1p-40;
  const signed char plus[2] = {1, 1}, minus[2] = {-1, -1};
  EXPECT_TRUE(slideway::has_digits(problem, 2, plus));
  EXPECT_FALSE(slideway::has_digits(problem, 2, minus));
}

// ---- state.hpp

TEST(Contracts, InputsAreZeroUnlessGiven) {
  const slideway::Input input;
  EXPECT_EQ(input.value, 0.0);
  EXPECT_EQ(input.rate, 0.0);
  EXPECT_EQ(input.acceleration, 0.0);
}

TEST(Contracts, StatesAreEqualIffEveryFieldIs) {
  using State = slideway::State<slideway::Size<1, 2, 2, 3, 0, 0, 0, 0, 0, 0>>;
  const State plain;
  EXPECT_TRUE(plain == State{});
  EXPECT_FALSE(plain != State{});
  const auto expect_seen = [&](const char* what, auto&& change) {
    State other = plain;
    change(other);
    EXPECT_FALSE(plain == other) << what;
    EXPECT_TRUE(plain != other) << what;
  };
  expect_seen("start", [](State& s) { s.start = 1.0; });
  expect_seen("dt", [](State& s) { s.dt = 1.0; });
  expect_seen("steps", [](State& s) { s.steps = 1; });
  expect_seen("decided", [](State& s) { s.decided = true; });
  for (int j = 0; j < 2; ++j) {
    expect_seen("q", [&](State& s) { s.q[j] = 1.0; });
    expect_seen("v", [&](State& s) { s.v[j] = 1.0; });
  }
  for (int g = 0; g < 2; ++g) expect_seen("mode", [&](State& s) { s.mode[g] = 1; });
  for (int c = 0; c < 3; ++c) expect_seen("sign", [&](State& s) { s.sign[c] = 1; });
}

TEST(Contracts, WhatASceneHasNoneOfIsNotCompared) {
  // Arrays have one element at least; where the size is zero it means nothing.
  using State = slideway::State<slideway::Size<0, 0, 0, 0, 0, 0, 0, 0, 0, 0>>;
  State other;
  other.q[0] = other.v[0] = 1.0;
  other.mode[0] = other.sign[0] = 1;
  EXPECT_TRUE(State{} == other);
}

// ---- step.hpp

/// A body in the plane on a smooth straight line, 2^-10 m off it. The scene's length is `length`, m.
Stepper off_the_line(double length) {
  Scene<Room> scene;
  scene.bodies = scene.guides = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = scene.body[0].inertia = 1.0;
  scene.body[0].q[1] = 0x1p-10;
  scene.guide[0].origin.x = length;
  return Stepper(scene);
}

TEST(Contracts, TheDriftLimitItselfIsAllowed) {
  for (const double length : {1.0, 8.0, 64.0})
    for (const Method method : slideway::methods) {
      if (method == Method::kinematic) continue;  // the scene has no drives
      Stepper stepper = off_the_line(length);
      stepper.method = method;
      ASSERT_EQ(stepper.source.tables.length, length);
      const auto expect = [&](Status status, double limit) {
        stepper.drift_limit = limit;
        Stepper::State state = stepper.start();
        Stepper::Reaction reaction;
        const slideway::Report told = stepper.reaction(state, {}, reaction);
        EXPECT_EQ(told.status, status) << name(method);
        EXPECT_EQ(told.drift_position, 0x1p-10);
        const slideway::Report made = stepper.step(state, 1e-3);
        EXPECT_EQ(made.status, status) << name(method);
        EXPECT_EQ(made.drift_position, 0x1p-10);
        EXPECT_EQ(state == stepper.start(), status != Status::ok) << "a refusal leaves the state as it was";
      };
      const double limit = 0x1p-10 / length;  // exact: powers of two
      expect(Status::ok, limit);
      expect(Status::drift_limit, std::nextafter(limit, 0.0));
    }
}

TEST(Contracts, MoreausReactionAtTheStartIsThatOfTheInstant) {
  // No step has been made, dt = 0: there is nothing to be a mean over.
  Stepper stepper = off_the_line(1.0);
  Stepper::Reaction instant, means;
  ASSERT_EQ(stepper.reaction(stepper.start(), {}, instant).status, Status::ok);
  stepper.method = Method::moreau;
  ASSERT_EQ(stepper.start().dt, 0.0);
  ASSERT_EQ(stepper.reaction(stepper.start(), {}, means).status, Status::ok);
  for (int j = 0; j < 3; ++j) EXPECT_EQ(means.acceleration[j], instant.acceleration[j]);
  EXPECT_EQ(means.lambda[0], instant.lambda[0]);
}

// ---- method.hpp

TEST(Contracts, TwoMethodsLocateEvents) {
  int located = 0;
  for (const Method method : slideway::methods) {
    const bool expected = method == Method::rk4_located || method == Method::dop853_located;
    EXPECT_EQ(is_located(method), expected) << name(method);
    EXPECT_EQ(std::string(name(method)).find("_located") != std::string::npos, expected) << name(method);
    located += expected ? 1 : 0;
  }
  EXPECT_EQ(located, 2);
}

}  // namespace
