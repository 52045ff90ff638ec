// The stages of a Runge-Kutta step, and when they doubt that it is short enough.
#include <gtest/gtest.h>

#include <cmath>
#include <slideway/step.hpp>

namespace {

using slideway::Joint;
using slideway::Scene;
using slideway::Status;

using Size = slideway::Size<2, 2, 2, 2, 2, 2, 0, 2, 0, 0>;
using Source = slideway::RunTime<Size>;

/// Two oscillators that know nothing of each other, q'' = -q each: 1 kg on a slide, and 1 kg m^2 that turns.
Source oscillators() {
  Scene<Size> scene;
  scene.bodies = scene.joint_springs = 2;
  scene.body[0].joint = Joint::prismatic;
  scene.body[0].mass = 1;
  scene.body[1].joint = Joint::revolute;
  scene.body[1].inertia = 1;
  for (int i = 0; i < 2; ++i) {
    scene.joint_spring[i].body = i;
    scene.joint_spring[i].stiffness = 1;
  }
  return Source(scene);
}

constexpr double pi = 3.14159265358979323846;

/// Of q = amplitude cos(t + phase) in one of the coordinates, and rest in the other: does a step of h doubt itself?
template <const auto& tableau>
bool is_too_long(double h, double amplitude, double phase, int coordinate) {
  static const Source source = oscillators();
  const slideway::Solving solving{};
  const slideway::Inputs<Size> inputs{};
  slideway::Report report;
  const slideway::Setting<Source> setting{source, solving, inputs, 0, report};
  slideway::Phase<Size> y{};
  y.q[coordinate] = amplitude * std::cos(phase);
  y.v[coordinate] = -amplitude * std::sin(phase);
  slideway::Modes<Size> m{};
  slideway::Reaction<Size> first{};
  EXPECT_EQ(setting.evaluate(0, y, slideway::Aim::decide, true, m, first), Status::ok);
  slideway::Stages<tableau, Source> stages;
  EXPECT_EQ(stages.run(
                setting, 0, h, y, first, slideway::Aim::follow, m, [](int) {}, [](int, const auto&) {}),
            Status::ok);
  return stages.is_too_long(source, h);
}

TEST(AStepOfAnOscillation, IsTooLongFromALengthOnWhateverItsPhaseAndSize) {
  for (const double amplitude : {1.0, 0x1p-30, 0x1p40})
    for (const int coordinate : {0, 1})
      for (int k = 0; k < 64; ++k) {
        const double phase = 2 * pi * k / 64;
        EXPECT_FALSE(is_too_long<slideway::runge_kutta_4>(1.0 / 6, amplitude, phase, coordinate)) << phase;
        EXPECT_TRUE(is_too_long<slideway::runge_kutta_4>(2.0 / 3, amplitude, phase, coordinate)) << phase;
        EXPECT_FALSE(is_too_long<slideway::dormand_prince_8>(1, amplitude, phase, coordinate)) << phase;
        EXPECT_TRUE(is_too_long<slideway::dormand_prince_8>(5, amplitude, phase, coordinate)) << phase;
      }
}

TEST(AStepOfAnOscillation, ThatMovesNothingIsNotTooLong) {
  EXPECT_FALSE(is_too_long<slideway::runge_kutta_4>(2, 0x1p-60, 0, 0));
  EXPECT_FALSE(is_too_long<slideway::dormand_prince_8>(10, 0x1p-60, 0, 0));
}

TEST(Stages, TurnFarFromHalfARadianOnWhereThereIsFriction) {
  slideway::Tables<Size> tables = oscillators().tables;
  const double from[2] = {0, 1};
  const auto turns_far = [&](double slide, double turn) {
    const double to[2] = {from[0] + slide, from[1] + turn};
    Source source = oscillators();
    source.tables = tables;
    return slideway::turns_far(source, from, to);
  };
  EXPECT_FALSE(turns_far(0, 3));
  tables.rough = 1;
  EXPECT_FALSE(turns_far(3, 0.49));
  EXPECT_TRUE(turns_far(0, 0.51));
  EXPECT_TRUE(turns_far(0, -0.51));
}

}  // namespace
