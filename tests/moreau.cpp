// Moreau's method goes on where accelerations have no solution or several: finite, Coulomb's law exact, and no more
// energy of its own than docs/theory.md allows each step.
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

/// A planar body with all that is fixed to it.
struct RigidBody {
  double mass = 0, inertia = 0, lever = 0;  ///< about the centre of mass; from the origin to it

  explicit RigidBody(const Scene<io::RunSize>& scene) {
    Vec2 first = {};
    double about_origin = 0;
    for (int i = 0; i < scene.bodies; ++i) {
      const Body& body = scene.body[i];
      EXPECT_EQ(body.joint, i == 0 ? Joint::planar : Joint::fixed);
      EXPECT_TRUE(i == 0 || (body.parent == 0 && body.angle == 0));
      const Vec2 at = i == 0 ? body.com : body.at + body.com;
      mass += body.mass;
      first = first + body.mass * at;
      about_origin += body.inertia + body.mass * dot(at, at);
    }
    lever = std::sqrt(dot(first, first)) / mass;
    inertia = about_origin - mass * lever * lever;
  }

  /// The most energy that one step of h from speeds v to w may add, J: docs/theory.md, moreau.
  double most_gain(double h, double theta, double gravity, const double* v, const double* w) const {
    const double before = std::fabs(v[2]), after = std::fabs(w[2]), ahead = 1 - theta;
    const double moved_before = std::hypot(v[0], v[1]), moved_after = std::hypot(w[0], w[1]);
    const double moment = mass * lever;
    double slope = ahead * std::sqrt(mass) * gravity;
    if (lever > 0) {
      slope += moment * (theta * std::fabs(v[2] + w[2]) * moved_after / std::sqrt(inertia) +
                         ahead * before * before * (1 / std::sqrt(mass) + lever / std::sqrt(inertia)));
    }
    const auto cubic = [](double rate, double moved) { return rate * rate * rate * moved; };
    const double bend = 0.5 * moment *
                        (gravity * (theta * theta * after * after + ahead * ahead * before * before) +
                         theta * theta * cubic(after, moved_after) + ahead * ahead * cubic(before, moved_before));
    return h * h * (0.5 * slope * slope + bend);
  }
};

/// How far the forces of a step that ended in `after` are off Coulomb's law, over the largest.
double violation(const RunStepper& stepper, const RunState& after, const RunStepper::Reaction& r) {
  double largest = 1, worst = 0;
  for (int c = 0; c < stepper.source.tables.contacts; ++c) largest = std::fmax(largest, std::fabs(r.lambda[c]));
  for (int g = 0; g < stepper.source.scene.guides; ++g) {
    const Guide& guide = stepper.source.scene.guide[g];
    double limit = 0;
    for (int c = 0; c < guide.contacts; ++c) {
      limit += guide.mu * std::fabs(r.lambda[stepper.source.tables.first_contact[g] + c]);
    }
    // At rest within the limit; slipping at it, against the slip.
    const double against = -after.mode[g] * r.friction[g];
    const double off = after.mode[g] == 0 ? std::fmax(0, std::fabs(r.friction[g]) - limit) : std::fabs(against - limit);
    worst = std::fmax(worst, off / largest);
  }
  return worst;
}

/// What a run of moreau gains by itself and may gain, J, and how far its forces are off Coulomb's law, over the
/// largest.
struct Balance {
  double gain = 0, most = 0, violation = 0;
};

Balance balance_of(const RunStepper& stepper, double dt, double duration) {
  Balance sum;
  RunState state = stepper.start();
  const RigidBody body(stepper.source.scene);
  const double gravity = std::sqrt(dot(stepper.source.scene.gravity, stepper.source.scene.gravity));
  state.dt = dt;  // reactions are means of the step to come
  const auto steps = static_cast<long long>(std::lround(duration / dt));
  for (long long k = 0; k < steps; ++k) {
    RunStepper::Reaction r;
    const Report seen = stepper.reaction(state, {}, r);
    const RunState from = state;
    const Report report = stepper.step(state, dt);
    EXPECT_EQ(report.status, Status::ok) << sentence(report.status) << " at " << state.time();
    if (report.status != Status::ok) return {std::nan(""), 0, 0};
    EXPECT_EQ(seen.status, Status::ok);
    const EnergyFlow& flow = report.energy;
    const double before = energy(stepper, from), after = energy(stepper, state);
    const double gain = after - before - flow.work + flow.dissipated - flow.constraint_work;
    const double most = body.most_gain(dt, stepper.theta, gravity, from.v, state.v);
    // Some tens of roundings of what is added up.
    const double rounding = 64 * 0x1p-52 *
                            (std::fabs(before) + std::fabs(after) + std::fabs(flow.work) + std::fabs(flow.dissipated) +
                             std::fabs(flow.constraint_work) + stepper.kinetic_energy(state));
    EXPECT_LE(gain, most + rounding) << "at " << from.time();
    sum.gain += gain;
    sum.most += most;
    sum.violation = std::fmax(sum.violation, violation(stepper, state, r));
  }
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
    EXPECT_TRUE(std::isfinite(state.q[j]) && std::isfinite(state.v[j]));
  }
  return sum;
}

TEST_P(BeyondTheLimit, MoreauGoesOn) {
  RunStepper stepper = stepper_of(GetParam().scene, Method::moreau, GetParam().settings);
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  stepper.drift_limit = 1;
  for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
    const Balance balance = balance_of(stepper, dt, GetParam().duration);
    ASSERT_TRUE(std::isfinite(balance.gain)) << "dt " << dt;
    EXPECT_LT(balance.violation, 1e-12) << "dt " << dt;
    RecordProperty("gain_" + std::to_string(dt), testing::PrintToString(balance.gain));
    RecordProperty("most_" + std::to_string(dt), testing::PrintToString(balance.most));
    RecordProperty("violation_" + std::to_string(dt), testing::PrintToString(balance.violation));
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, BeyondTheLimit, testing::ValuesIn(cases),
                         [](const auto& one) { return std::string(one.param.name); });

/// The crank's angle after 1 ms by steps of dt, each checked.
double angle_after_one_millisecond(const std::string& scene, double dt) {
  const RunStepper stepper = stepper_of(scene, Method::moreau);
  RunState state = stepper.start();
  state.dt = dt;
  for (int k = 0; k < std::lround(1e-3 / dt); ++k) {
    RunStepper::Reaction r;
    EXPECT_EQ(stepper.reaction(state, {}, r).status, Status::ok) << scene;
    const Report report = stepper.step(state, dt);
    EXPECT_EQ(report.status, Status::ok) << scene << ": " << sentence(report.status) << " at " << state.time();
    if (report.status != Status::ok) break;
    EXPECT_EQ(report.uniqueness, Uniqueness::unproven) << scene;
    EXPECT_LE(report.solves, 20) << scene;
    EXPECT_LT(violation(stepper, state, r), 1e-12) << scene;
  }
  return state.q[0];
}

TEST(Moreau, TakesTheLikeliestModeWhereThereAreMoreThanMayBeTried) {
  for (const char* const scene : {"v_engine_4", "v_engine_8", "v_engine_16"}) {
    const RunStepper exact = stepper_of(scene, Method::dop853_located);
    const double truth = run(exact, exact.start(), 1e-4, 10).state.q[0];
    const double coarse = std::fabs(angle_after_one_millisecond(scene, 2e-5) - truth);
    const double fine = std::fabs(angle_after_one_millisecond(scene, 5e-6) - truth);
    EXPECT_GT(coarse / fine, 3) << scene;  // order 1: 4
    EXPECT_LT(coarse / fine, 5) << scene;
  }
}

TEST(Moreau, BringsAnEngineToRest) {
  RunStepper stepper = stepper_of("v_engine_4", Method::moreau);
  stepper.stabilise = Stabilise::projection;
  RunState state = stepper.start();
  for (double& v : state.v) v *= 0.01;  // near rest it is the contact forces that tell whither a piston goes
  for (int k = 0; k < 1200; ++k) {
    const Report report = stepper.step(state, 1e-3);
    ASSERT_EQ(report.status, Status::ok) << sentence(report.status) << " at " << state.time();
  }
  for (int g = 0; g < stepper.source.scene.guides; ++g) EXPECT_EQ(state.mode[g], 0);
}

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
