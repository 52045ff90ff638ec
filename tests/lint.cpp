// slideway lint: what each piece of advice is given for, what it is not, and that following it does what it says.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "support/command.hpp"

namespace {

using nlohmann::json;
using namespace test;

class Lint : public CommandTest {
 protected:
  /// The messages on an item.
  std::vector<std::string> advice(const std::string& arguments, const std::string& item) const {
    const Result result = slideway("lint " + arguments + " --json $TMP/lint.json", tmp);
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> messages;
    const json document = json::parse(read(tmp / "lint.json"));
    for (const json& finding : document["findings"]) {
      if (finding["item"] == item) messages.push_back(finding["message"]);
    }
    return messages;
  }
  bool is_advised(const std::string& arguments, const std::string& item, const std::string& words) const {
    for (const std::string& message : advice(arguments, item)) {
      if (message.find(words) != message.npos) return true;
    }
    return false;
  }
  json run(const std::string& arguments) const {
    const Result result = slideway("run " + arguments + " --quiet --json $TMP/run.json", tmp);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.err;
    return json::parse(read(tmp / "run.json"));
  }
  /// The number after some words of a message.
  static double number_after(const std::string& message, const std::string& words) {
    const std::size_t at = message.find(words);
    EXPECT_NE(at, message.npos) << message;
    return at == message.npos ? std::nan("") : std::stod(message.substr(at + words.size()));
  }
};

TEST_F(Lint, AdvisesKinematicWhereDrivesMoveAllAndNowhereElse) {
  EXPECT_TRUE(is_advised("crank_rocker", "scene", "moved by its drives alone"));
  EXPECT_FALSE(is_advised("crank_rocker --set 'run.method=\"kinematic\"'", "scene", "drives alone")) << "it is";
  EXPECT_FALSE(is_advised("crank_rocker_free", "scene", "drives alone"));
}

TEST_F(Lint, TellsTheDriftOfBothMethods) {
  const std::string message = advice("crank_rocker", "scene").at(0);
  const std::string first_steps = "crank_rocker --duration 1 --method ";
  EXPECT_NEAR(number_after(message, "it drifts by "), run(first_steps + "kinematic")["drift_position"], 1e-17);
  const double drift = run(first_steps + "rk4")["drift_position"];
  EXPECT_NEAR(number_after(message, ", not "), drift, 0.05 * drift);
}

TEST_F(Lint, NamesInertiaThatADriveTurnsAtAConstantRate) {
  EXPECT_TRUE(is_advised("slider_crank_driven", "body 'crank'", "inertia does little"));
  EXPECT_FALSE(is_advised("slider_crank_driven", "body 'rod'", "inertia does little"));
  EXPECT_FALSE(is_advised("slider_crank_driven", "body 'slider'", "inertia does little"))
      << "free to turn, it does not";
  EXPECT_FALSE(is_advised("crank_rocker_free", "body 'crank'", "inertia does little"));
}

TEST_F(Lint, LeavesInertiaThatADriveSpeedsUp) {
  write(tmp / "wheel.toml", R"(name = "wheel"
gravity = [0.0, -9.81]
[[body]]
name = "crank"
parent = "ground"
mass = 1.0
com = [0.1, 0.0]
inertia = 1.0
[[drive]]
name = "motor"
body = "crank"
law = "polynomial"
coefficients = [0.0, 1.0, 0.5]
)");
  EXPECT_FALSE(is_advised("wheel.toml", "body 'crank'", "inertia does little"));
  EXPECT_TRUE(is_advised("wheel.toml --set body.crank.inertia=1e-6", "body 'crank'", "inertia does little"));
  EXPECT_TRUE(
      is_advised("wheel.toml --set 'drive.motor.coefficients=[0.0, 1.0]'", "body 'crank'", "inertia does little"));
}

TEST_F(Lint, AdvisesAPointWhereTheSpanOfTwoContactsDoesNothing) {
  EXPECT_TRUE(is_advised("slider_crank_driven", "guide 'way'", "a point would do"));
  EXPECT_TRUE(is_advised("v_engine_4", "guide 'cylinder_1'", "(and 3 more)"));
  const std::string heavy = "crank_rocker_offset --set body.block.inertia=0.1";
  EXPECT_FALSE(is_advised(heavy, "guide 'slot'", "a point would do")) << "what turns it is a couple of the contacts";
  EXPECT_TRUE(is_advised("crank_rocker_offset", "guide 'slot'", "a point would do"));
  const std::string beside =
      "slider_crank_driven --set 'guide.way.origin=[0, 0.01]' "
      "--set 'guide.way.contacts=[[-0.025, 0.01], [0.025, 0.01]]'";
  EXPECT_FALSE(is_advised(beside, "guide 'way'", "a point would do")) << "its friction has an arm";
}

TEST_F(Lint, APointDoesWhatLintSays) {
  const std::string message = advice("slider_crank_driven", "guide 'way'").at(0);
  EXPECT_LT(number_after(message, "forces of guides by "), 1e-12);
  EXPECT_LT(number_after(message, "of drives by "), 1e-12);
  std::string text = read(SLIDEWAY_SOURCE_DIR "/scenes/slider_crank_driven.toml");
  text += "\n";
  const std::size_t slider = text.find("name = \"slider\"");
  const std::size_t joint = text.find("joint = \"revolute\"", slider);
  text.replace(joint, std::strlen("joint = \"revolute\""), "joint = \"fixed\"");
  for (const char* key : {"q = ", "v = "}) {
    const std::size_t line = text.find(std::string("\n") + key, joint);
    text.erase(line, text.find('\n', line + 1) - line);
  }
  write(tmp / "point.toml", text);
  const json two = run("slider_crank_driven");
  const json point = run("point.toml --set body.slider.inertia=0 --set 'guide.way.contacts=[[0, 0]]'");
  const auto torque = [](const json& of) { return of["reactions"]["drive"]["motor"].get<double>(); };
  EXPECT_NEAR(torque(point), torque(two), 1e-11 * std::fabs(torque(two)));
  const auto& both = two["reactions"]["lambda"]["way"];
  EXPECT_NEAR(point["reactions"]["lambda"]["way"][0], both[0].get<double>() + both[1].get<double>(), 1e-10);
}

TEST_F(Lint, NamesFrictionThatDoesLittle) {
  EXPECT_TRUE(is_advised("crank_rocker_offset --set guide.slot.mu=1e-5", "guide 'slot'", "does little"));
  EXPECT_FALSE(is_advised("crank_rocker_offset", "guide 'slot'", "does little"));
}

constexpr char pendulum[] = R"(name = "pendulum"
gravity = [0.0, -9.81]
[[body]]
name = "post"
parent = "ground"
joint = "fixed"
at = [0.5, 1.0]
mass = 1.0
inertia = 1.0
[[body]]
name = "rod"
parent = "ground"
joint = "planar"
mass = 2.0
inertia = 0.2
com = [0.1, 0.0]
q = [1.0, 1.0, 0.0]
v = [0.0, 1.0, 2.0]
[[pin]]
name = "bearing"
a = "rod"
a_at = [-0.5, 0.0]
b = "post"
[[spring]]
a = "rod"
a_at = [0.3, 0.1]
b_at = [1.0, 2.0]
stiffness = 10.0
damping = 0.5
)";

TEST_F(Lint, NamesPinsThatCouldBeRevoluteJoints) {
  write(tmp / "pendulum.toml", pendulum);
  EXPECT_TRUE(is_advised("pendulum.toml", "pin 'bearing'", "revolute joint"));
  const std::string message = advice("pendulum.toml", "pin 'bearing'").at(0);
  EXPECT_LT(number_after(message, "places change by "), 1e-6) << "drift apart, the same motion";
  const std::string driven = std::string(pendulum) + R"([[drive]]
name = "turn"
body = "rod"
coordinate = "angle"
law = "uniform"
start = 0.0
rate = 2.0
)";
  write(tmp / "driven.toml", driven);
  EXPECT_FALSE(is_advised("driven.toml", "pin 'bearing'", "revolute joint")) << "its drive names a planar coordinate";
  EXPECT_FALSE(is_advised("squeezer", "pin 'b'", "revolute joint")) << "it closes a loop of a tree";
}

TEST_F(Lint, TriesNothingWhereLiveInputsWouldHaveToBeGuessed) {
  write(tmp / "pushed.toml", read(SLIDEWAY_SOURCE_DIR "/scenes/slider_crank_driven.toml") + R"(
[[load]]
body = "rod"
torque = 1.0
input = "push"
)");
  EXPECT_TRUE(advice("pushed.toml", "guide 'way'").empty());
  EXPECT_TRUE(advice("pushed.toml", "scene").empty());
}

TEST_F(Lint, TriesNothingWhereTheFirstStepIsRefused) {
  const std::string jam = "slider_crank_equal --set guide.way.mu=30";
  ASSERT_EQ(slideway("run " + jam + " --quiet", tmp).status, 1);
  EXPECT_TRUE(advice(jam, "scene").empty());
  EXPECT_TRUE(advice(jam, "body 'crank'").empty());
}

}  // namespace
