// Moreau's method goes on where accelerations have no solution or several: finite, Coulomb's law exact, and no energy
// of its own but what a step's curvature leaves.
#include <gtest/gtest.h>

#include <cmath>
#include <support/steppers.hpp>

namespace {

using namespace slideway;
using namespace slideway::test;

struct Beyond {
  const char* name;
  const char* scene;
  std::vector<std::string> settings;
  double duration;
  Status accelerations;  ///< what they say of the start, or on the way
};

void PrintTo(const Beyond& b, std::ostream* out) { *out << b.name; }

const std::vector<Beyond> cases = {
    {"rod_on_two_guides", "rod_on_two_guides", {"guide.flat.mu=0.3", "guide.inclined.mu=0.3"}, 0.5, Status::not_unique},
    {"overhung_two", "overhung_slider", {"guide.way.mu=0.2"}, 2, Status::not_unique},
    {"overhung_none", "overhung_slider", {"guide.way.mu=0.2", "load.load1.torque=0.05"}, 2, Status::no_solution},
    {"painleve_rod_two", "painleve_rod", {"guide.wire.mu=1.5"}, 1, Status::not_unique},
    {"painleve_rod_none", "painleve_rod", {"guide.wire.mu=1.5", "body.rod.v=[-4, 0, 0]"}, 1, Status::no_solution},
    {"painleve_klein_none",
     "painleve_klein",
     {"guide.rough.mu=1.5", "load.push.force=[-0.5, 0]"},
     1,
     Status::no_solution}};

class BeyondTheLimit : public testing::TestWithParam<Beyond> {};

TEST_P(BeyondTheLimit, AccelerationsAreRefused) {
  const RunStepper stepper = stepper_of(GetParam().scene, Method::rk4_located, GetParam().settings);
  RunStepper::Reaction r;
  EXPECT_EQ(stepper.reaction(stepper.start(), {}, r).status, GetParam().accelerations);
}

/// Energy that a run of moreau gains by itself: docs/theory.md. Final - initial - work + dissipated - constraint_work.
double gained(const RunStepper& stepper, double dt, double duration, double& violation) {
  RunState state = stepper.start();
  const double before = energy(stepper, state);
  EnergyFlow flow;
  state.dt = dt;  // reactions are means of the step to come
  const auto steps = static_cast<long long>(std::lround(duration / dt));
  for (long long k = 0; k < steps; ++k) {
    RunStepper::Reaction r;
    const Report seen = stepper.reaction(state, {}, r);
    const Report report = stepper.step(state, dt);
    EXPECT_EQ(report.status, Status::ok) << sentence(report.status) << " at " << state.time();
    if (report.status != Status::ok) return std::nan("");
    EXPECT_EQ(seen.status, Status::ok);
    add(flow, 1, report.energy);
    for (int g = 0; g < stepper.source.scene.guides; ++g) {
      const Guide& guide = stepper.source.scene.guide[g];
      double limit = 0, largest = 1;
      for (int c = 0; c < guide.contacts; ++c) {
        limit += guide.mu * std::fabs(r.lambda[stepper.source.tables.first_contact[g] + c]);
      }
      for (int c = 0; c < stepper.source.tables.contacts; ++c) largest = std::fmax(largest, std::fabs(r.lambda[c]));
      // At rest within the limit; slipping at it, against the slip.
      const double against = -state.mode[g] * r.friction[g];
      const double off =
          state.mode[g] == 0 ? std::fmax(0, std::fabs(r.friction[g]) - limit) : std::fabs(against - limit);
      violation = std::fmax(violation, off / largest);
    }
  }
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
    EXPECT_TRUE(std::isfinite(state.q[j]) && std::isfinite(state.v[j]));
  }
  return energy(stepper, state) - before - flow.work + flow.dissipated - flow.constraint_work;
}

TEST_P(BeyondTheLimit, MoreauGoesOn) {
  RunStepper stepper = stepper_of(GetParam().scene, Method::moreau, GetParam().settings);
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  stepper.drift_limit = 1;
  double violation = 0;
  double last = 0;
  for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
    const double gain = gained(stepper, dt, GetParam().duration, violation);
    ASSERT_TRUE(std::isfinite(gain));
    // J; of order dt: see docs/theory.md for the bound's derivation.
    EXPECT_LT(gain, 50 * dt) << "dt " << dt;
    last = gain;
    RecordProperty("gain_" + std::to_string(dt), testing::PrintToString(gain));
  }
  (void)last;
  EXPECT_LT(violation, 1e-12);
  RecordProperty("violation", testing::PrintToString(violation));
}

INSTANTIATE_TEST_SUITE_P(Cases, BeyondTheLimit, testing::ValuesIn(cases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Moreau, IsOfOrderOne) {
  const auto end = [](double dt) {
    const RunStepper stepper = stepper_of("crank_rocker_offset", Method::moreau);
    return run(stepper, stepper.start(), dt, std::lround(0.1 / dt)).state.q[0];
  };
  RunStepper exact = stepper_of("crank_rocker_offset", Method::dop853_located);
  const double truth = run(exact, exact.start(), 1e-3, 100).state.q[0];
  const double coarse = std::fabs(end(1e-3) - truth), fine = std::fabs(end(1.25e-4) - truth);
  EXPECT_GT(coarse / fine, 5);
  EXPECT_LT(fine, 1e-4);
}

TEST(Moreau, HoldsWithMuStaticAndSlidesWithMu) {
  const RunStepper stepper = stepper_of("belt", Method::moreau);
  const History r = run(stepper, stepper.start(), 1e-3, 16000);
  ASSERT_EQ(r.last.status, Status::ok);
  EXPECT_EQ(r.unlocated, 3);  // slip, stick, slip
  EXPECT_NEAR(r.state.q[1], 0.5583072933, 2e-3);
}

}  // namespace
