// No wrong number: random parameters around the limits of every scene where methods fail, all methods, judged by the
// oracle. A wrong number is an answer with `ok` that violates an equation, or whose error exceeds ten times what the
// method's order promises without a word in the report (unlocated methods count what they step over).
//
// SLIDEWAY_DRAWS draws a scene, 1000 by default; SLIDEWAY_SEED chooses others. A failure prints the draw that shows it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <slideway/properties/step.hpp>
#include <support/steppers.hpp>

namespace {

using namespace slideway;
using namespace slideway::test;

struct Limits {
  const char* scene;
  double mu;  ///< where it fails, or a usual one
  double dt;
};

void PrintTo(const Limits& l, std::ostream* out) { *out << l.scene; }

int from_environment(const char* name, int usual) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : usual;
}

/// One draw: the scene with its coefficients, loads and speeds changed. Coefficients are within 1e-8 of the limit, not
/// so near that the rounding of a double decides, or anywhere; speeds are zero, or the scene's, or any.
struct Draw {
  Scene<Room> scene;
  std::string text;
};

Draw draw(const Limits& limits, std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const auto pick = [&](int n) { return std::uniform_int_distribution(0, n - 1)(random); };
  const auto factor = [&] {
    const double side = pick(2) == 0 ? 1 : -1;
    return pick(2) == 0 ? 1 + side * std::pow(10, uniform(-11, -8)) : uniform(0.3, 2);
  };
  Draw d{scene_of(limits.scene), ""};
  for (int g = 0; g < d.scene.guides; ++g) {
    Guide& guide = d.scene.guide[g];
    if (guide.mu == 0 && guide.mu_static == 0) continue;
    guide.mu = limits.mu * factor();
    guide.mu_static = guide.mu * (pick(2) == 0 ? 1 : uniform(1, 1.5));
    d.text += " mu " + std::to_string(guide.mu) + "/" + std::to_string(guide.mu_static);
  }
  // Without weight and load there is rounding alone to judge.
  const double without = d.scene.gravity.y == 0 ? 0.5 : 0.0;
  const double load = std::array{1.0, without, uniform(-2, 2)}[static_cast<std::size_t>(pick(3))];
  for (int l = 0; l < d.scene.loads; ++l) {
    d.scene.load[l].force = {load * d.scene.load[l].force.x, load * d.scene.load[l].force.y};
    d.scene.load[l].torque *= load;
  }
  const double speed =
      d.scene.drives > 0 ? 1 : std::array{1.0, 0.0, -1.0, uniform(-2, 2)}[static_cast<std::size_t>(pick(4))];
  for (int i = 0; i < d.scene.bodies; ++i) {
    for (double& v : d.scene.body[i].v) v *= speed;
  }
  d.text += " load " + std::to_string(load) + " speed " + std::to_string(speed);
  return d;
}

struct Tally {
  int instants = 0, refused = 0, wrong = 0, runs = 0, late = 0;
};

/// The forces at a state against the oracle's.
void judge(const RunStepper& stepper, const RunState& state, const std::string& what, Tally& tally) {
  ++tally.instants;
  const properties::InstantJudgement judgement = properties::judge_instant(stepper, state);
  tally.refused += judgement.answered ? 0 : 1;
  if (judgement.violation.empty()) return;
  ++tally.wrong;
  ADD_FAILURE() << what << ": " << judgement.violation;
}

double distance(const RunStepper& stepper, const RunState& a, const RunState& b, double& size) {
  double most = 0;
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
    most = std::fmax(most, std::fabs(a.q[j] - b.q[j]));
    size = std::fmax(size, std::fabs(a.q[j]));
  }
  return most;
}

class WrongNumbersFull : public testing::TestWithParam<Limits> {};

TEST_P(WrongNumbersFull, AreNone) {
  const Limits& limits = GetParam();
  const int draws = from_environment("SLIDEWAY_DRAWS", 1000), seed = from_environment("SLIDEWAY_SEED", 1);
  constexpr int steps = 8;
  Tally tally;
  for (int k = 0; k < draws && !HasFatalFailure(); ++k) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed) * 1000003u + static_cast<std::uint64_t>(k));
    const Draw d = draw(limits, random);
    const std::string what = std::string(limits.scene) + " draw " + std::to_string(k) + ":" + d.text;
    RunStepper stepper(d.scene);
    judge(stepper, stepper.start(), what, tally);
    RunStepper::Reaction first;
    double largest_acceleration = 0;
    if (stepper.reaction(stepper.start(), {}, first).status == Status::ok) {
      for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
        largest_acceleration = std::fmax(largest_acceleration, std::fabs(first.acceleration[j]));
      }
    }
    stepper.method = Method::dop853_located;
    // The judge's own error is what halving its step changes: forces that grow a hundredfold in a step are hard for it,
    // too.
    const History truth = run(stepper, stepper.start(), limits.dt / 8, 8 * steps),
                  coarser_truth = run(stepper, stepper.start(), limits.dt / 4, 4 * steps);
    for (const Method method : integrating) {
      stepper.method = method;
      const History coarse = run(stepper, stepper.start(), limits.dt, steps);
      if (coarse.last.status != Status::ok) continue;
      ++tally.runs;
      const History fine[] = {run(stepper, stepper.start(), limits.dt / 2, 2 * steps),
                              run(stepper, stepper.start(), limits.dt / 3, 3 * steps)};
      RunStepper accelerations(d.scene);
      if (method == Method::rk4_located) judge(accelerations, coarse.state, what + " end", tally);
      if (truth.last.status != Status::ok || coarser_truth.last.status != Status::ok ||
          fine[0].last.status != Status::ok || fine[1].last.status != Status::ok) {
        continue;
      }
      double size = 0;
      const double error = distance(stepper, coarse.state, truth.state, size);
      // Order p and a half or a third of the step differ by (1 - 2^-p) of the error, at least half of it; plus rounding
      // of some steps, and of forces as far as they move the mechanism. Both, since a located method halves a step that
      // is too long for it, and half a step is the same again.
      const double change = std::fmax(distance(stepper, coarse.state, fine[0].state, size),
                                      distance(stepper, coarse.state, fine[1].state, size));
      const double promise = 2 * change + 2 * distance(stepper, truth.state, coarser_truth.state, size) +
                             1e-13 * (1 + size) + 1e-12 * largest_acceleration * std::pow(steps * limits.dt, 2);
      if (error <= 10 * promise || coarse.unlocated > 0) continue;
      ++tally.late;
      ADD_FAILURE() << what << " " << name(method) << ": off by " << error << " m, promised " << promise;
    }
  }
  RecordProperty("instants", tally.instants);
  RecordProperty("refused", tally.refused);
  RecordProperty("runs", tally.runs);
  RecordProperty("wrong", tally.wrong + tally.late);
  EXPECT_EQ(tally.wrong + tally.late, 0);
  EXPECT_GT(tally.instants - tally.refused, draws / 10);  // else nothing was judged
}

INSTANTIATE_TEST_SUITE_P(Scenes, WrongNumbersFull,
                         testing::Values(Limits{"block_on_plane", 0.8, 1e-3}, Limits{"pushed_block", 0.25, 1e-3},
                                         Limits{"belt", 0.2, 1e-2}, Limits{"overhung_slider", 1.0 / 6, 1e-3},
                                         Limits{"rod_on_two_guides", 0.267949192431, 1e-3},
                                         Limits{"elliptic_trammel", 1, 1e-3}, Limits{"trammel_at_rest", 0.5, 1e-3},
                                         Limits{"painleve_klein", 1, 1e-3}, Limits{"painleve_rod", 4.0 / 3, 1e-3},
                                         Limits{"slider_crank_driven", 1.5, 1e-3},
                                         Limits{"slider_crank_equal", 0.9, 1e-3}, Limits{"high_mass_ratio", 1.5, 1e-3},
                                         Limits{"slider_crank", 0.3, 1e-5}, Limits{"crank_rocker_free", 0.4, 1e-3}),
                         [](const auto& one) { return std::string(one.param.scene); });

}  // namespace
