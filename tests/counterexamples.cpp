// Mechanisms that a property has found the kernel wrong on, smallest form, one a file in tests/data/mechanisms: what
// must hold of every step holds of theirs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <slideway/properties/symmetry.hpp>
#include <support/steppers.hpp>

namespace {

using namespace slideway;
using namespace slideway::test;
using properties::Violation;

const std::filesystem::path directory = SLIDEWAY_SOURCE_DIR "/tests/data/mechanisms";

std::vector<std::string> names() {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    found.push_back(entry.path().stem().string());
  std::sort(found.begin(), found.end());
  return found;
}

Scene<Room> read(const std::string& name) {
  const auto reading = io::read_scene((directory / (name + ".toml")).string());
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene ? reading.scene->scene : Scene<Room>{};
}

RunStepper stepper_of_file(const std::string& name, Method method) {
  RunStepper stepper(read(name));
  stepper.method = method;
  return stepper;
}

class Counterexample : public testing::TestWithParam<std::tuple<std::string, Method>> {};

constexpr double dt = 0x1p-10;

TEST_P(Counterexample, HoldsToEveryProperty) {
  const auto& [name, method] = GetParam();
  const RunStepper stepper = stepper_of_file(name, method);
  RunState state = stepper.start();
  for (int k = 0; k < 200; ++k) {
    RunState before;
    std::memcpy(&before, &state, sizeof state);
    const Report report = stepper.step(state, dt);
    ASSERT_EQ(properties::step_contract(stepper, before, state, report, dt), Violation{}) << "step " << k;
    if (report.status != Status::ok) break;
    if (method != Method::moreau) {
      ASSERT_EQ(properties::coulomb(stepper, state), Violation{}) << "step " << k;
    }
  }
}

/// In other units the same bits. (In a mirror a contact force that is zero takes part with the other face's column, and
/// rounding with it: there it only has to run.)
TEST_P(Counterexample, IsTheSameHoweverWrittenDown) {
  const auto& [name, method] = GetParam();
  const Scene<Room> scene = read(name);
  const properties::Seen views[] = {properties::in_units(scene, -8, -8, -8), properties::mirrored(scene),
                                    properties::with_guides_reversed(scene)};
  for (const properties::Seen& seen : views) {
    RunStepper one(scene), other(seen.scene);
    one.method = other.method = method;
    one.drift_limit = other.drift_limit = 1e300;  // of angles it is a number a metre
    RunState a = one.start(), b = seen.state(a);
    for (int k = 0; k < 8; ++k) {
      const Report first = one.step(a, dt), second = other.step(b, dt * seen.time);
      if (&seen != views && (first.status != Status::ok || second.status != Status::ok)) break;
      ASSERT_STREQ(slideway::name(first.status), slideway::name(second.status)) << "step " << k;
      const RunState expected = seen.state(a);
      for (int j = 0; j < one.source.tables.coordinates && &seen == views; ++j) {
        ASSERT_EQ(expected.q[j], b.q[j]) << "step " << k << ", coordinate " << j;
        ASSERT_EQ(expected.v[j], b.v[j]) << "step " << k << ", coordinate " << j;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Counterexample,
                         testing::Combine(testing::ValuesIn(names()), testing::ValuesIn(integrating)),
                         [](const auto& one) {
                           return std::get<0>(one.param) + "_" + slideway::name(std::get<1>(one.param));
                         });

History of_file(const std::string& name, Method method, int steps) {
  const RunStepper stepper = stepper_of_file(name, method);
  return run(stepper, stepper.start(), dt, steps);
}

TEST(Events, DoNotComeFromRounding) {
  for (const Method method : located) {
    EXPECT_EQ(of_file("stops_with_forces_of_noise", method, 50).last.status, Status::ok);
    EXPECT_EQ(of_file("slides_with_forces_of_noise", method, 50).last.status, Status::ok);
  }
}

/// Friction leaves it two forces from the start, which is refused; along the signs it goes on, until the force passes
/// through infinity.
TEST(Events, AreNoPoles) {
  for (const Method method : located) {
    RunStepper stepper = stepper_of_file("runs_into_a_pole", method);
    const Report refused = run(stepper, stepper.start(), dt, 1).last;
    EXPECT_EQ(refused.status, Status::not_unique);
    EXPECT_EQ(refused.guide, 1);
    stepper.hlcp.not_unique = NotUnique::continue_along_signs;
    EXPECT_EQ(run(stepper, stepper.start(), dt, 10).last.status, Status::singular_constraints);
  }
  // With steps as long as these the pole itself is what a bracket ends at.
  RunStepper stepper = stepper_of_file("runs_into_a_pole", Method::dop853_located);
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  bool named = false;
  for (int k = 1; k <= 64; ++k) {
    const Report report = run(stepper, stepper.start(), 4 * k * dt, 20).last;
    EXPECT_EQ(report.status, Status::singular_constraints) << "dt " << 4 * k * dt;
    named = named || report.guide != none;
  }
  EXPECT_TRUE(named);
}

TEST(Uniqueness, IsNotClaimedWhereTheSlipIsRounding) {
  const RunStepper stepper = stepper_of_file("locked_on_a_moving_body", Method::rk4_located);
  RunStepper::Reaction r;
  EXPECT_EQ(stepper.reaction(stepper.start(), {}, r).uniqueness, Uniqueness::motion_only);
}

}  // namespace
