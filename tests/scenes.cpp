// Every shipped scene, as its file says: method, dt and duration are the scene's defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <ostream>
#include <slideway/io/stepper.hpp>
#include <string>
#include <vector>

#include "support/allocations.hpp"
#include "support/litter.hpp"

namespace {

using slideway::Method;
using slideway::Report;
using slideway::Status;
using slideway::Uniqueness;
using slideway::io::RunSize;
using Stepper = slideway::RunTimeStepper<RunSize>;

const std::filesystem::path scenes = std::filesystem::path(SLIDEWAY_SOURCE_DIR) / "scenes";

slideway::io::SceneFile read(const std::string& name) {
  const slideway::io::Reading reading = slideway::io::read_scene((scenes / (name + ".toml")).string());
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene.value_or(slideway::io::SceneFile{});
}

Method method_of(const std::string& name) {
  for (const Method method : slideway::methods) {
    if (name == slideway::name(method)) return method;
  }
  ADD_FAILURE() << "no method '" << name << "'";
  return Method::rk4;
}

/// What is known of a scene's end from elsewhere.
struct End {
  int coordinate;
  double q, v;
};

struct Known {
  const char* scene;
  double q_bar, v_bar;  ///< largest error of a position and a speed, over max(1, |value|)
  std::vector<End> end;
  Uniqueness uniqueness = Uniqueness::certified;  ///< weakest of the run
};

void PrintTo(const Known& scene, std::ostream* out) { *out << scene.scene; }

constexpr double unknown = std::numeric_limits<double>::infinity();  // a bar

/// Ends of the default runs, printed with ten decimals by a program of its own for these scenes: Cartesian coordinates
/// of every body, the whole KKT system with partial pivoting, long double, rk4 with the same dt, so with the same
/// errors, at unlocated events too; 1e-9 leaves room for 5e-11 of printing and as much of rounding, grown along the
/// run. But: crank-rockers and quick_return: closed forms after whole turns, so that the bar is for the method's own
/// error; overhung_slider: v0 t - t^2 / 2, which rk4 has without error; squeezer: the published positions, good to 1e-9
/// (Bari IVP test set); high_mass_ratio, slider_crank_equal: closed forms, the first after whole turns; painleve_klein:
/// v0 t + t^2 / 12, without error; painleve_rod: its reference of 30 digits; pushed_block, trammel_at_rest: they stay
/// where they are, to the creep that tests/rest.cpp allows. block_on_plane: v0^2 / (2 mu g), by a located stop; belt:
/// its reference, to ten printed digits.
const std::vector<Known> known = {
    {"belt", 1e-10, 1e-10, {{0, 1.6, 0.1}, {1, 0.5583072933, -0.3479934870}, {2, 0, 0}, {3, 0, 0}}},
    {"block_on_plane", 1e-12, 1e-12, {{0, 0.25484199796126402, 0}, {1, 0, 0}, {2, 0, 0}}},
    {"high_mass_ratio",
     1e-9,
     1e-9,
     {{0, 13.566370614359172, 10}, {1, -14.000626524983008, -12.977911251195022}, {2, 0.4342559106, 2.9779112512}}},
    {"painleve_klein", 1e-12, 1e-12, {{0, 13.0 / 12, 7.0 / 6}, {1, 0, 0}, {2, 0, 0}}},
    {"painleve_rod", 1e-9, 1e-9, {{0, 2.0527333985, 3.2759428023}, {1, 0, 0}, {2, -1.0096892012, -4.4553130321}}},
    {"pushed_block", 1e-13, 1e-13, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}},
    {"slider_crank_equal", 1e-12, 1e-12, {{0, 1.3653981633974483, 2}, {1, -2.7307963267948966, -4}}},
    {"trammel_at_rest", 1e-13, 1e-13, {{0, 0.96, 0}, {1, 0.28, 0}, {2, 0, 0}}, Uniqueness::motion_only},
    {"crank_rocker", 1e-9, 1e-9, {{0, 1.1071487178, 0.6}, {1, 12.5663706144, 3}}},
    {"crank_rocker_stiff", 1e-9, 1e-9, {{0, 1.1071487178, 0.6}, {1, 12.5663706144, 3}}},
    {"crank_rocker_weightless", 1e-9, 1e-9, {{0, 1.1071487178, 0.6}, {1, 12.5663706144, 3}}},
    {"crank_rocker_two_contacts", 1e-9, 1e-9, {{0, 1.1071487178, 0.6}, {1, 12.5663706144, 3}}},
    {"crank_rocker_free",
     1e-9,
     1e-9,
     {{0, 1.3224930030, 0.1085408180}, {1, -1.3052661175, -0.1330850528}, {2, 2.6277591205, 0.2416258708}}},
    {"crank_rocker_offset",
     1e-9,
     1e-9,
     {{0, 1.0850259580, -0.3145333289}, {1, -1.2326982412, 0.5042825154}, {2, 2.3177241993, -0.8188158443}}},
    {"slider_crank",
     1e-9,
     1e-9,
     {{0, 9.0982514068, 141.8591491927}, {1, -9.2593245254, -73.7963161827}, {2, 0.1610731186, -68.0628330100}}},
    {"slider_crank_driven", 1e-9, 1e-9, {{0, 13.3517687778, 10}, {1, -13.7131359018, -13.7796447290}}},
    {"elliptic_trammel",
     1e-9,
     1e-9,
     {{0, -0.5893394369, -1.2936663366}, {1, -0.8078855291, 0.9437086852}, {2, 5.3426299327, 1.6012990580}}},
    {"rod_on_two_guides",
     1e-9,
     1e-9,
     {{0, 3.6055511582, 0.0002524617}, {1, 0.9608396417, -0.0760622239}, {2, 1.8515761349, 0.2744888146}}},
    {"overhung_slider", 1e-12, 1e-12, {{0, 0.48, 0.2}, {1, 0, 0}, {2, 0, 0}}},
    {"quick_return",
     1e-9,
     1e-9,
     {{0, 1.1071487178, 1.2},
      {1, 12.5663706144, 6},
      {3, -1.1710963136, -2.4099497856},
      {4, 0.0639475958, 1.2099497856}}},
    {"gantry", 1e-9, 1e-9, {{0, 0, 0.8}, {1, 0, 0}, {2, 0, 0}, {4, -0.3280861692, 0.7898243056}}},
    {"squeezer",
     1e-9,
     unknown,
     {{0, 15.81077119, 0},
      {1, -15.75637106, 0},
      {2, 0.0408222402, 0},
      {3, 0.5244099659, 0},
      {4, -0.5347301163, 0},
      {5, 1.0480807410, 0},
      {6, 0.5347301163, 0}}},
    {"four_bar_chain",
     1e-9,
     1e-9,
     {{0, -1.0720478941, -0.5230542001}, {4, -1.0720478941, -0.5230542001}, {8, 1.0720478941, 0.5230542001}}},
    {"v_engine_2", 1e-9, 1e-9, {{0, 5.9085832077, 85.4603254752}}},
    {"v_engine_4", 1e-9, 1e-9, {{0, 6.1964952652, 93.8715059676}}},
    {"v_engine_8", 1e-9, 1e-9, {{0, 6.1961718759, 93.8658317082}}},
    {"v_engine_16", 1e-9, 1e-9, {{0, 6.1492795357, 95.0574986064}}}};

/// Made to show a refusal: there is no run to know the end of.
struct Refused {
  const char* scene;
  Status status;
};
const std::vector<Refused> refused = {{"three_contacts", Status::singular_constraints}};

TEST(Scenes, AllAreKnownHere) {
  std::vector<std::string> files, listed;
  for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().stem().string());
  }
  for (const Known& scene : known) listed.emplace_back(scene.scene);
  for (const Refused& scene : refused) listed.emplace_back(scene.scene);
  std::sort(files.begin(), files.end());
  std::sort(listed.begin(), listed.end());
  EXPECT_EQ(files, listed);
}

TEST(Scenes, ThatAreMadeToBeRefusedAre) {
  for (const Refused& scene : refused) {
    const slideway::io::SceneFile file = read(scene.scene);
    Stepper stepper(file.scene);
    for (const Method method : {Method::euler, Method::rk4}) {
      stepper.method = method;
      auto state = stepper.start();
      const auto before = state;
      EXPECT_EQ(stepper.step(state, file.run.dt).status, scene.status) << scene.scene << ", " << name(method);
      EXPECT_TRUE(state == before) << scene.scene << ", " << name(method);
    }
  }
}

/// A whole run, with the worst of everything.
struct History {
  Status status = Status::ok;
  Uniqueness uniqueness = Uniqueness::certified;
  double residual = 0;          ///< in units of its rounding scale
  double least_dissipated = 0;  ///< of one step, J
  int unlocated_events = 0;
  slideway::EnergyFlow energy;
  double initial = 0, final = 0;  ///< energy, J
  double in_play = 0;             ///< max kinetic + range of potential + |work|, J
  Stepper::State end;

  double imbalance() const {
    const double miss = std::fabs(final - initial - (energy.work - energy.dissipated + energy.constraint_work));
    return miss / std::fmax(in_play, 1e-6);  // J; at rest nothing is in play, and the miss is rounding, 1e-15
  }
};

History run(const slideway::io::SceneFile& file, const Stepper& stepper) {
  History history;
  auto& state = history.end = stepper.start();
  double most_kinetic = 0, least = stepper.potential_energy(state), most = least;
  history.initial = stepper.kinetic_energy(state) + least;
  const double whole = std::floor(file.run.duration / file.run.dt + 1e-9);
  for (long k = 0; k <= static_cast<long>(whole) && history.status == Status::ok; ++k) {
    double dt = file.run.dt;
    if (k == static_cast<long>(whole)) dt = file.run.duration - state.time();  // the last step is shorter
    if (dt <= 1e-9 * file.run.dt) break;
    const Report report = stepper.step(state, dt);
    history.status = report.status;
    history.uniqueness = std::max(history.uniqueness, report.uniqueness);
    history.residual = std::fmax(history.residual, report.residual);
    history.least_dissipated = std::fmin(history.least_dissipated, report.energy.dissipated);
    history.unlocated_events += report.unlocated_events;
    history.energy.work += report.energy.work;
    history.energy.dissipated += report.energy.dissipated;
    history.energy.constraint_work += report.energy.constraint_work;
    const double potential = stepper.potential_energy(state);
    most_kinetic = std::fmax(most_kinetic, stepper.kinetic_energy(state));
    least = std::fmin(least, potential);
    most = std::fmax(most, potential);
  }
  history.final = stepper.kinetic_energy(state) + stepper.potential_energy(state);
  history.in_play = most_kinetic + (most - least) + std::fabs(history.energy.work);
  return history;
}

class SceneRun : public testing::TestWithParam<Known> {};

TEST_P(SceneRun, EndsWhereItIsKnownToEndAndKeepsItsBooks) {
  const slideway::io::SceneFile file = read(GetParam().scene);
  Stepper stepper(file.scene);
  stepper.method = method_of(file.run.method);
  const History history = run(file, stepper);

  EXPECT_EQ(history.status, Status::ok) << sentence(history.status);
  EXPECT_EQ(history.uniqueness, GetParam().uniqueness) << name(history.uniqueness);
  // Measured: at most 1.2e-14. A few eps for each of up to 100 equations.
  EXPECT_LT(history.residual, 1e-13);
  // Each stage's power is mu sum |lambda T q'| >= 0, and the weights are positive: no rounding can make it negative.
  EXPECT_GE(history.least_dissipated, 0);
  // Of the energy in play; the project's bars. An unlocated event leaves an error of first or second order in dt.
  const double bar = history.unlocated_events == 0 ? 1e-8 : 1e-5;
  EXPECT_LT(history.imbalance(), bar) << history.unlocated_events << " unlocated events";
  // s; five ulps of the duration: a product, a difference and a sum take one each.
  EXPECT_NEAR(history.end.time(), file.run.duration, 1e-15 * file.run.duration);

  double worst_q = 0, worst_v = 0;
  for (const End& end : GetParam().end) {
    const auto miss = [](double x, double is) { return std::fabs(x - is) / std::fmax(1, std::fabs(is)); };
    const double q = miss(history.end.q[end.coordinate], end.q), v = miss(history.end.v[end.coordinate], end.v);
    EXPECT_LT(q, GetParam().q_bar) << "q of coordinate " << end.coordinate;
    EXPECT_LT(v, GetParam().v_bar) << "v of coordinate " << end.coordinate;
    worst_q = std::fmax(worst_q, q);
    worst_v = std::fmax(worst_v, v);
  }
  RecordProperty("imbalance", testing::PrintToString(history.imbalance()));
  RecordProperty("unlocated_events", history.unlocated_events);
  RecordProperty("residual", testing::PrintToString(history.residual));
  RecordProperty("q", testing::PrintToString(worst_q));
  RecordProperty("v", testing::PrintToString(worst_v));
}

TEST_P(SceneRun, EndsThereKinematicallyIfItIsFullyDrivenAndIsRefusedElse) {
  const slideway::io::SceneFile file = read(GetParam().scene);
  Stepper stepper(file.scene);
  stepper.method = Method::kinematic;
  if (!fully_driven(stepper.source)) {
    auto state = stepper.start();
    EXPECT_EQ(stepper.step(state, file.run.dt).status, Status::invalid_input);
    return;
  }
  const History history = run(file, stepper);
  EXPECT_EQ(history.status, Status::ok) << sentence(history.status);
  EXPECT_EQ(history.uniqueness, GetParam().uniqueness) << name(history.uniqueness);
  EXPECT_GE(history.least_dissipated, 0);
  EXPECT_LT(history.imbalance(), history.unlocated_events == 0 ? 1e-8 : 1e-5);  // as above
  for (const End& end : GetParam().end) {
    // No error but of rounding and of printing, 5e-11, and where rk4 with its drift was printed, its own 1e-10 of the
    // value.
    EXPECT_NEAR(history.end.q[end.coordinate], end.q, 1e-9 * std::fmax(1, std::fabs(end.q))) << end.coordinate;
    EXPECT_NEAR(history.end.v[end.coordinate], end.v, 1e-9 * std::fmax(1, std::fabs(end.v))) << end.coordinate;
  }
  RecordProperty("imbalance", testing::PrintToString(history.imbalance()));
}

/// Allocations of step(), reaction() and project() by every method, steps that are refused included.
TEST_P(SceneRun, AsksNothingOfTheHeap) {
  if (!slideway::test::allocations_are_counted()) GTEST_SKIP() << "not counted: not glibc, or a sanitizer's malloc";
  const slideway::io::SceneFile file = read(GetParam().scene);
  Stepper stepper(file.scene);
  for (const Method method : {Method::euler, Method::rk4, Method::kinematic}) {
    stepper.method = method;
    auto state = stepper.start();
    Stepper::Reaction reaction;
    const std::size_t before = slideway::test::allocations();
    stepper.project(state);
    for (int k = 0; k < 20; ++k) {
      stepper.step(state, file.run.dt);
      stepper.reaction(state, {}, reaction);
    }
    stepper.step(state, -1);
    const std::size_t after = slideway::test::allocations();
    EXPECT_EQ(after - before, 0u) << name(method);
    EXPECT_TRUE(state.steps == 20 || method == Method::kinematic) << name(method);
  }
}

TEST_P(SceneRun, ReadsNothingThatWasNotSet) {
  const slideway::io::SceneFile file = read(GetParam().scene);
  Stepper stepper(file.scene);
  for (const Method method : slideway::methods) {
    stepper.method = method;
    auto clean = stepper.start(), littered = clean;
    for (int k = 0; k < 3; ++k) {
      const Status expected = stepper.step(clean, file.run.dt).status;
      slideway::test::litter_stack();
      EXPECT_EQ(stepper.step(littered, file.run.dt).status, expected) << name(method);
    }
    for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
      EXPECT_EQ(littered.q[j], clean.q[j]) << name(method);
      EXPECT_EQ(littered.v[j], clean.v[j]) << name(method);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, SceneRun, testing::ValuesIn(known),
                         [](const auto& instance) { return std::string(instance.param.scene); });

}  // namespace
