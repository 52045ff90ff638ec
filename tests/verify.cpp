// slideway verify: what it checks, what it says, and that every shipped scene passes.
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

TEST_F(Verify, DoesNotPassABlockThatCreepsAfterItsStop) {
  const json document = this->document("overhung_slider --duration 2", 1);
  EXPECT_FALSE(document["verified"]);
  EXPECT_EQ(document["status"], "ok");  // the kernel does not see it; the oracle's block stops at 1 s
  EXPECT_EQ(document["oracle"]["events"][0]["kind"], "stick");
  EXPECT_FALSE(check(document, "Over the run", "events")["held"]);
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

class VerifyFull : public Verify, public testing::WithParamInterface<const char*> {};

TEST_P(VerifyFull, PassesAShippedScene) {
  const Result result = verify(GetParam());
  EXPECT_EQ(result.status, 0) << result.out << result.err;
}

// v_engine_8 and v_engine_16 take minutes: `slideway verify v_engine_16`.
INSTANTIATE_TEST_SUITE_P(Scenes, VerifyFull,
                         testing::Values("crank_rocker_free", "crank_rocker_offset", "crank_rocker_two_contacts",
                                         "crank_rocker_weightless", "elliptic_trammel", "four_bar_chain", "gantry",
                                         "high_mass_ratio", "overhung_slider", "painleve_klein", "painleve_rod",
                                         "quick_return", "rod_on_two_guides", "slider_crank", "slider_crank_driven",
                                         "slider_crank_equal", "squeezer", "v_engine_2", "v_engine_4"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
