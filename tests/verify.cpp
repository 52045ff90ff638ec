// slideway verify: what it checks, what it says, and that every shipped scene passes.
#include <algorithm>
#include <tuple>

#include "support/command.hpp"

namespace {

using nlohmann::json;
using namespace test;

class Verify : public CommandTest {
 protected:
  Result verify(const std::string& arguments) const { return slideway("verify " + arguments, tmp); }
  json document(const std::string& arguments, int status) const {
    const Result result = verify(arguments + " --quiet --json verify.json");
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    return json::parse(read(tmp / "verify.json"));
  }
};

const json& check(const json& document, const std::string& group, const std::string& quantity) {
  static const json nothing;
  for (const json& one : document["groups"]) {
    if (one["title"] != group) continue;
    for (const json& line : one["checks"]) {
      if (line["quantity"] == quantity) return line;
    }
  }
  ADD_FAILURE() << group << " has no " << quantity;
  return nothing;
}

TEST_F(Verify, ChecksEveryQuantityOfTheCrankRocker) {
  const json document = this->document("crank_rocker", 0);
  EXPECT_TRUE(document["verified"]);
  EXPECT_GE(document["oracle"]["digits"], 30);
  EXPECT_EQ(document["oracle"]["events"].size(), 8U);  // slip and contact force reverse together, twice a turn
  EXPECT_EQ(document["not_checked"].size(), 0U);
  const std::string states = "At states of the run", run = "Over the run";
  for (const char* quantity : {"accelerations", "contact forces", "friction", "drive forces", "energy"}) {
    EXPECT_GE(check(document, states, quantity)["digits"], 12) << quantity;
  }
  for (const char* quantity : {"complementarity", "dissipation", "uniqueness"}) {
    EXPECT_EQ(check(document, states, quantity)["error"], 0) << quantity;
  }
  EXPECT_GE(check(document, "Step by step", "positions after a step")["digits"], 15);
  const json& drift = check(document, "Step by step", "drift");
  EXPECT_LT(drift["bound"], 100 * drift["error"].get<double>());
  for (const char* quantity :
       {"positions", "speeds", "contact forces", "friction", "drive forces", "energy", "work", "dissipated"}) {
    EXPECT_GE(check(document, run, quantity)["digits"], 9) << quantity;
  }
  EXPECT_LE(check(document, run, "event times")["error"], 2e-3);
}

TEST_F(Verify, HoldsItsDocumentToTheSchema) {
  ASSERT_EQ(verify("overhung_slider --quiet --json one.json").status, 0);
  ASSERT_EQ(verify("gantry --duration 0.1 --method kinematic --quiet --json two.json").status, 0);
  ASSERT_EQ(verify("overhung_slider --set guide.way.mu=0.2 --quiet --json three.json").status, 1);
  hold_to_schema("verify", "one.json two.json three.json");
}

TEST_F(Verify, SaysWhichDigitsAreMissing) {
  const Result result = verify("overhung_slider --duration 0.1 --digits 16");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.out.find("FAILS at t = "), result.out.npos) << result.out;
  EXPECT_NE(result.out.find("\nNOT VERIFIED\n"), result.out.npos) << result.out;
  EXPECT_EQ(verify("overhung_slider --duration 0.1 --digits 10").status, 0);
}

/// Its last speed but one is 1 mm/s; by euler and rk4 it stops with the step, located within it to rounding.
TEST_F(Verify, FollowsABlockThroughItsStop) {
  for (const char* method : {"euler", "rk4", "rk4_located", "dop853_located", "moreau"}) {
    SCOPED_TRACE(method);
    const json document = this->document("overhung_slider --duration 2 --method " + std::string(method), 0);
    EXPECT_EQ(document["oracle"]["events"][0]["kind"], "stick");
    EXPECT_EQ(check(document, "Over the run", "modes")["error"], 0);
    const json& times = check(document, "Over the run", "event times");
    EXPECT_LT(times["bound"], std::string(method).find("located") == std::string::npos ? 3e-3 : 1e-9);
  }
}

TEST_F(Verify, SeesEventsThatAreMadeUpOrMissed) {
  // Sixteen seconds of stick and slip, of which one slip is missed by far with a step of half a second.
  const json document = this->document("belt --dt 0.5", 1);
  EXPECT_FALSE(document["verified"]);
}

TEST_F(Verify, ComparesMotionAloneWhereForcesAreAChoice) {
  for (const char* method : {"rk4", "rk4_located"}) {
    SCOPED_TRACE(method);
    const json document = this->document("trammel_at_rest --duration 0.1 --method " + std::string(method), 0);
    const std::string not_checked = document["not_checked"].dump();
    EXPECT_NE(not_checked.find("they are a choice"), not_checked.npos) << not_checked;
    EXPECT_NE(not_checked.find("those claimed satisfy the equations and the limits"), not_checked.npos) << not_checked;
    EXPECT_EQ(check(document, "At states of the run", "rest")["error"], 0);
    EXPECT_EQ(check(document, "At states of the run", "uniqueness")["error"], 0);
  }
}

TEST_F(Verify, FollowsABlockThatRestsOnAMovingArm) {
  const std::string rider = SLIDEWAY_SOURCE_DIR "/tests/wrong_kernels/rider.toml";
  for (const char* options : {"", " --method rk4_located", " --method dop853_located --stabilise projection",
                              " --method euler", " --method moreau"}) {
    const json document = this->document(rider + options, 0);
    EXPECT_EQ(document["oracle"]["events"][0]["kind"], "slip") << options;
  }
}

TEST_F(Verify, HoldsProjectionToItsOwnLimit) {
  const json document = this->document("crank_rocker_free --duration 0.3 --stabilise projection", 0);
  EXPECT_LT(check(document, "Step by step", "drift")["bound"], 1e-13);
}

TEST_F(Verify, TellsWhyTheKernelRefused) {
  const Result result = verify("overhung_slider --set guide.way.mu=0.2");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("overhung_slider: at t = 0 s: "), result.err.npos) << result.err;
}

TEST_F(Verify, ComparesFromTheProjectedStartWithTheGainsAsked) {
  EXPECT_EQ(verify("crank_rocker_offset --duration 0.2 --alpha 5 --beta 30 --project-start").status, 0);
}

TEST_F(Verify, HoldsEulerToItsOwnOrder) {
  EXPECT_EQ(verify("rod_on_two_guides --method euler").status, 0);
  EXPECT_EQ(verify("rod_on_two_guides --method moreau").status, 0);
  EXPECT_EQ(verify("crank_rocker_offset --method euler").status, 0);
}

TEST_F(Verify, DoesNotPassARunThatIsFarFromConverged) {
  write(tmp / "pendulum.toml", R"(name = "pendulum"
gravity = [0.0, -9.81]
[[body]]
name = "rod"
parent = "ground"
mass = 1.0
com = [1.0, 0.0]
inertia = 0.1
)");
  EXPECT_EQ(verify("pendulum.toml --dt 1e-3 --duration 3").status, 0);
  const Result coarse = verify("pendulum.toml --dt 1 --duration 20");
  EXPECT_EQ(coarse.status, 1) << coarse.out;
}

TEST_F(Verify, FollowsADriveWhoseSeriesHasGaps) {
  write(tmp / "quartic.toml", R"(name = "quartic"
[[body]]
name = "crank"
parent = "ground"
mass = 1.0
com = [0.5, 0.0]
inertia = 0.1
[[drive]]
name = "motor"
body = "crank"
law = "polynomial"
coefficients = [0, 0, 0, 0, 1]
[run]
duration = 2.0
)");
  EXPECT_EQ(verify("quartic.toml").status, 0);
}

TEST_F(Verify, RefusesWhatRunRefuses) {
  const Result method = verify("slider_crank --method kinematic");
  EXPECT_EQ(method.status, 2);
  EXPECT_NE(method.err.find("method kinematic needs a scene that its drives move fully"), method.err.npos);
  EXPECT_EQ(verify("crank_rocker --digits 17").status, 2);
  EXPECT_EQ(verify("crank_rocker --csv -").status, 2);
  EXPECT_EQ(verify("no_such_scene").status, 2);
}

class VerifyFull : public Verify, public testing::WithParamInterface<std::tuple<const char*, const char*>> {};

TEST_P(VerifyFull, PassesAShippedScene) {
  const auto [options, scene] = GetParam();
  const Result result = verify(scene + std::string(" ") + options);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
}

/// The part of a test's name: without what names cannot have.
std::string test_name(const testing::TestParamInfo<std::tuple<const char*, const char*>>& test) {
  std::string name = std::get<1>(test.param) + std::string("_") + std::get<0>(test.param);
  name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return c == '-'; }), name.end());
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

using testing::Combine;
using testing::Values;

// v_engine_8 and v_engine_16 take minutes: `slideway verify v_engine_16`.
const auto methods_of_order = Values("--method rk4", "--method rk4_located", "--method dop853_located");
INSTANTIATE_TEST_SUITE_P(Scenes, VerifyFull,
                         Combine(methods_of_order,
                                 Values("belt", "block_on_plane", "crank_rocker_free", "crank_rocker_offset",
                                        "crank_rocker_two_contacts", "crank_rocker_stiff", "crank_rocker_weightless",
                                        "elliptic_trammel", "four_bar_chain", "gantry", "high_mass_ratio",
                                        "overhung_slider", "painleve_klein", "painleve_rod", "pushed_block",
                                        "quick_return", "rod_on_two_guides", "slider_crank_driven",
                                        "slider_crank_equal", "squeezer", "trammel_at_rest")),
                         test_name);
INSTANTIATE_TEST_SUITE_P(LongScenes, VerifyFull,
                         Combine(Values("--method rk4"), Values("slider_crank", "v_engine_2", "v_engine_4")),
                         test_name);

// Of order 1: with steps of 1 ms Baumgarte's terms alone keep few of them within the drift limit.
INSTANTIATE_TEST_SUITE_P(Euler, VerifyFull,
                         Combine(Values("--method euler --stabilise projection"),
                                 Values("belt", "block_on_plane", "crank_rocker_free", "crank_rocker_two_contacts",
                                        "elliptic_trammel", "four_bar_chain", "gantry", "high_mass_ratio",
                                        "painleve_rod", "pushed_block", "quick_return", "slider_crank_driven",
                                        "trammel_at_rest")),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Moreau, VerifyFull,
                         Combine(Values("--method moreau"),
                                 Values("belt", "block_on_plane", "crank_rocker", "crank_rocker_two_contacts",
                                        "four_bar_chain", "gantry", "painleve_klein", "painleve_rod", "pushed_block",
                                        "rod_on_two_guides", "slider_crank_equal", "trammel_at_rest")),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Driven, VerifyFull,
                         Combine(Values("--method kinematic"),
                                 Values("crank_rocker", "gantry", "high_mass_ratio", "quick_return",
                                        "slider_crank_driven", "slider_crank_equal")),
                         test_name);

}  // namespace
