// Scene files: what a text becomes, and where each defect is.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <slideway/io/export.hpp>
#include <slideway/io/scene_file.hpp>
#include <slideway/io/start.hpp>
#include <slideway/io/text.hpp>
#include <slideway/scenes/crank_rocker.hpp>
#include <slideway/scenes/gantry.hpp>
#include <slideway/scenes/squeezer.hpp>
#include <string>

namespace slideway::io {
namespace {

const std::string body = R"(
[[body]]
name = "block"
parent = "ground"
joint = "planar"
mass = 2
inertia = 0.5
)";
const std::string guide = R"(
[[guide]]
name = "way"
slider = "block"
rail = "ground"
direction = [3.0, 4.0]
contacts = [[0.0, 0.0]]
mu = 0.2
)";

/// A scene that must have no defects.
SceneFile good(const std::string& text, const std::vector<std::string>& settings = {}) {
  Reading reading = parse_scene("name = \"test\"\n" + text, "test.toml", settings);
  for (const FileDefect& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene.value_or(SceneFile{});
}

/// The messages of a scene that must have defects.
std::vector<std::string> bad(const std::string& text, const std::vector<std::string>& settings = {}) {
  const Reading reading = parse_scene("name = \"test\"\n" + text, "test.toml", settings);
  EXPECT_FALSE(reading.scene.has_value());
  std::vector<std::string> messages;
  for (const FileDefect& defect : reading.defects) messages.push_back(to_string(defect));
  return messages;
}

std::string drive(const std::string& law) {
  return "[[drive]]\nname = \"motor\"\nbody = \"block\"\ncoordinate = \"y\"\n" + law + "\n";
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

TEST(SceneFile, TakesWhatIsWritten) {
  const SceneFile file = good("gravity = [1, -9.81]" + body + guide + "[baumgarte]\nbeta = 3\n[run]\ndt = 0.5\n");
  EXPECT_EQ(file.name, "test");
  EXPECT_EQ(file.scene.gravity.x, 1);
  EXPECT_EQ(file.scene.gravity.y, -9.81);
  EXPECT_EQ(file.scene.bodies, 1);
  EXPECT_EQ(file.scene.body[0].mass, 2) << "an integer is a number";
  EXPECT_EQ(file.scene.body[0].joint, Joint::planar);
  EXPECT_EQ(file.scene.alpha, 20);
  EXPECT_EQ(file.scene.beta, 3);
  EXPECT_EQ(file.run.dt, 0.5);
  EXPECT_EQ(file.line(Item::guide, 0), 10);
  EXPECT_EQ(file.title(Item::guide, 0), "guide 'way'");
}

TEST(SceneFile, HasTheDefaultsOfTheDesign) {
  const SceneFile file = good(
      "[[body]]\nname = \"rod\"\nparent = \"ground\"\nmass = 1\ninertia = 1\n[[pin]]\nname = \"p\"\na = \"rod\"\n"
      "[[spring]]\na = \"rod\"\n[[load]]\nbody = \"rod\"\n");
  const Scene<RunSize>& scene = file.scene;
  EXPECT_EQ(scene.body[0].joint, Joint::revolute);
  EXPECT_EQ(scene.body[0].parent, ground);
  EXPECT_EQ(scene.body[0].q[0], 0);
  EXPECT_EQ(scene.gravity.y, 0);
  EXPECT_EQ(scene.alpha, 20);
  EXPECT_EQ(scene.beta, 100);
  EXPECT_EQ(scene.pin[0].b, ground);
  EXPECT_EQ(scene.spring[0].b, ground);
  EXPECT_EQ(scene.load[0].input, none);
  EXPECT_EQ(file.run.method, "rk4");
  EXPECT_EQ(file.run.dt, 1e-3);
  EXPECT_EQ(file.run.duration, 1);
  EXPECT_EQ(file.spring_names[0], "spring1");
  EXPECT_EQ(file.load_names[0], "load1");
}

TEST(SceneFile, StaticFrictionIsKineticFrictionUnlessWritten) {
  EXPECT_EQ(good(body + guide).scene.guide[0].mu_static, 0.2);
  EXPECT_EQ(good(body + guide + "mu_static = 0.3\n").scene.guide[0].mu_static, 0.3);
}

TEST(SceneFile, TurnOfNoAngleIsExact) {
  const Vec2 none_given = good(body).scene.body[0].turn;
  EXPECT_TRUE(same_bits(none_given.x, 1) && same_bits(none_given.y, 0));
  const Vec2 turn = good(body + "angle = 0.5\n").scene.body[0].turn;
  EXPECT_EQ(turn.x, std::cos(0.5));
  EXPECT_EQ(turn.y, std::sin(0.5));
}

TEST(SceneFile, TangentsHaveUnitLengthAtEveryScale) {
  const auto tangent = [](const std::string& direction) {
    return good(body + guide, {"guide.way.direction=" + direction}).scene.guide[0].tangent;
  };
  for (const char* axis : {"[1, 0]", "[7e-300, 0]", "[1e300, 0]", "[4.9e-324, 0]", "[0.1, 0]"}) {
    EXPECT_TRUE(same_bits(tangent(axis).x, 1) && tangent(axis).y == 0) << axis;
  }
  EXPECT_EQ(tangent("[0, -0.3]").y, -1);
  for (const char* slanted : {"[3, 4]", "[3e307, 4e307]", "[3e-310, 4e-310]"}) {
    EXPECT_NEAR(tangent(slanted).x, 0.6, 1e-15) << slanted;
    EXPECT_NEAR(tangent(slanted).y, 0.8, 1e-15) << slanted;
  }
}

TEST(SceneFile, DrivenCoordinatesStartOnTheirLaw) {
  const auto start = [](const std::string& law) {
    const Body block = good(body + "q = [1, 2, 3]\nv = [4, 5, 6]\n" + drive(law)).scene.body[0];
    EXPECT_EQ(block.q[0], 1);
    EXPECT_EQ(block.v[2], 6);
    return std::pair(block.q[1], block.v[1]);
  };
  EXPECT_EQ(start("law = \"uniform\"\nstart = 0.25\nrate = 3"), std::pair(0.25, 3.0));
  EXPECT_EQ(start("law = \"polynomial\"\ncoefficients = [0.5, -1, 7]"), std::pair(0.5, -1.0));
  EXPECT_EQ(start("law = \"harmonic\"\noffset = 1\namplitude = 2\nfrequency = 5"), std::pair(1.0, 10.0));
  EXPECT_EQ(start("law = \"harmonic\"\namplitude = 2\nfrequency = 5\nphase = 0.7"),
            std::pair(2 * std::sin(0.7), 10 * std::cos(0.7)));
  EXPECT_EQ(start("law = \"input\"\ninput = \"live\""), std::pair(2.0, 5.0)) << "what is given";
}

TEST(SceneFile, InputsAreCountedByName) {
  const SceneFile file =
      good(body + drive("law = \"input\"\ninput = \"live\"") +
           "[[load]]\nbody = \"block\"\ninput = \"push\"\n[[load]]\nbody = \"block\"\ninput = \"live\"\n");
  EXPECT_EQ(file.input_names, (std::vector<std::string>{"live", "push"}));
  EXPECT_EQ(file.scene.inputs, 2);
  EXPECT_EQ(file.scene.load[1].input, 0);
}

TEST(SceneFile, EveryDefectIsToldInTheOrderOfTheFile) {
  const auto messages = bad("gravity = 9.81\n" + body + "colour = 1\n" + guide + "rail = 2\n");
  ASSERT_EQ(messages.size(), 1u) << "a syntax error stands alone";
  EXPECT_EQ(messages[0].substr(0, 22), "test.toml:19: is not T");
  const auto all = bad("gravity = 9.81\n" + body + "colour = 1\n" + guide + "slip = 2\n");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], "test.toml:2: scene: gravity must be two numbers: [x, y]");
  EXPECT_EQ(all[1].substr(0, 45), "test.toml:10: body 'block': unknown key 'colo");
  EXPECT_EQ(all[2].substr(0, 42), "test.toml:19: guide 'way': unknown key 'sl");
}

TEST(SceneFile, MessagesHoldNoControlCharacters) {
  const auto messages = bad(body + "\"\\u001b[2J\" = 1\n");
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].find('\x1b'), std::string::npos);
}

TEST(SceneFile, SettingsReplaceAddAndNameThemselves) {
  const std::string text = body + guide + "[[spring]]\na = \"block\"\n" + drive("law = \"uniform\"\nrate = 1");
  const SceneFile file = good(text, {"guide.way.mu=0.7", "body.block.com=[1, 2]", "spring.spring1.stiffness=5",
                                     "baumgarte.alpha=1", "run.method=euler", "gravity=[0, -1]"});
  EXPECT_EQ(file.scene.guide[0].mu, 0.7);
  EXPECT_EQ(file.scene.guide[0].mu_static, 0.7);
  EXPECT_EQ(file.scene.body[0].com.y, 2);
  EXPECT_EQ(file.scene.spring[0].stiffness, 5);
  EXPECT_EQ(file.scene.alpha, 1);
  EXPECT_EQ(file.run.method, "euler");
  EXPECT_EQ(file.scene.gravity.y, -1);
  EXPECT_EQ(file.settings.size(), 6u);
  EXPECT_EQ(file.hash, good(text).hash);
  EXPECT_EQ(bad(text, {"guide.way.mu=true"}),
            std::vector<std::string>{"--set guide.way.mu=true: guide 'way': mu must be a number"});
  EXPECT_EQ(bad(text, {"body.block.mass=1\ninertia=2"}).size(), 1u);
}

TEST(SceneFile, HashTellsTextsApart) {
  EXPECT_EQ(fnv1a(""), "cbf29ce484222325");
  EXPECT_EQ(fnv1a("a"), "af63dc4c8601ec8c");
  EXPECT_NE(good(body).hash, good(body + "# other\n").hash);
}

TEST(SceneFile, MasslessFreeCoordinatesAreNamed) {
  const auto masses = [](const std::string& text) {
    std::vector<std::string> messages;
    for (const FileDefect& defect : check_masses(good(text))) messages.push_back(to_string(defect));
    return messages;
  };
  EXPECT_TRUE(masses(body).empty());
  EXPECT_EQ(masses("[[body]]\nname = \"rod\"\nparent = \"ground\"\nmass = 0\ninertia = 0\n").size(), 1u);
  const std::string massless = "[[body]]\nname = \"rod\"\nparent = \"ground\"\nmass = 0\ninertia = 0\n";
  EXPECT_TRUE(masses(massless + "[[drive]]\nname = \"m\"\nbody = \"rod\"\nlaw = \"uniform\"\nrate = 1\n").empty())
      << "driven coordinates need no mass";
  EXPECT_TRUE(masses(massless + "[[body]]\nname = \"tip\"\nparent = \"rod\"\njoint = \"fixed\"\nat = [1, 0]\nmass = 1\n"
                                "inertia = 0\n")
                  .empty())
      << "what it carries counts";
}

TEST(SceneFile, StartsAreHeldToTheSceneSize) {
  const auto misses = [](const std::string& y) {
    return check_start(good(body + "com = [2, 0]\nq = [0, " + y + ", 0]\n" + guide, {"guide.way.direction=[1, 0]"}))
        .size();
  };
  EXPECT_EQ(misses("0"), 0u);
  EXPECT_EQ(misses("1.9e-9"), 0u) << "2 m is the largest length here";
  EXPECT_EQ(misses("2.1e-9"), 1u);
}

TEST(SceneFile, ShippedScenesHaveNoDefects) {
  for (const auto& entry : std::filesystem::directory_iterator(SLIDEWAY_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Reading reading = read_scene(entry.path().string());
    ASSERT_TRUE(reading.scene) << to_string(reading.defects.at(0));
    EXPECT_EQ(reading.scene->name, entry.path().stem()) << "a scene is called like its file";
    EXPECT_TRUE(check_masses(*reading.scene).empty()) << entry.path();
    EXPECT_TRUE(check_start(*reading.scene).empty()) << entry.path();
    EXPECT_EQ(export_problem(*reading.scene), "");
  }
}

/// Compares all bytes that the counts make part of the scene.
template <class Exported>
void expect_same(const Exported& exported, const std::string& name) {
  const Reading reading = read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml");
  ASSERT_TRUE(reading.scene);
  const Scene<RunSize>& read = reading.scene->scene;
  EXPECT_EQ(exported.bodies, Exported::Size::bodies) << "no room to spare";
  EXPECT_EQ(coordinates(exported), Exported::Size::coordinates);
  ASSERT_EQ(exported.bodies, read.bodies);
  for (int i = 0; i < read.bodies; ++i) {
    const Body &a = exported.body[i], &b = read.body[i];
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.joint, b.joint);
    const double numbers[][2] = {{a.at.x, b.at.x},     {a.at.y, b.at.y}, {a.angle, b.angle},     {a.turn.x, b.turn.x},
                                 {a.turn.y, b.turn.y}, {a.mass, b.mass}, {a.com.x, b.com.x},     {a.com.y, b.com.y},
                                 {a.q[0], b.q[0]},     {a.v[0], b.v[0]}, {a.inertia, b.inertia}, {a.q[2], b.q[2]}};
    for (const auto& pair : numbers) EXPECT_TRUE(same_bits(pair[0], pair[1])) << pair[0];
  }
  ASSERT_EQ(exported.guides, read.guides);
  for (int g = 0; g < read.guides; ++g) {
    const Guide &a = exported.guide[g], &b = read.guide[g];
    EXPECT_EQ(a.slider, b.slider);
    EXPECT_EQ(a.contacts, b.contacts);
    EXPECT_TRUE(same_bits(a.mu, b.mu) && same_bits(a.tangent.x, b.tangent.x) && same_bits(a.origin.y, b.origin.y));
    EXPECT_TRUE(same_bits(a.contact[1].x, b.contact[1].x));
  }
  ASSERT_EQ(exported.drives, read.drives);
  for (int d = 0; d < read.drives; ++d) {
    EXPECT_EQ(exported.drive[d].law, read.drive[d].law);
    EXPECT_EQ(exported.drive[d].terms, read.drive[d].terms);
    for (int k = 0; k < 8; ++k) EXPECT_TRUE(same_bits(exported.drive[d].c[k], read.drive[d].c[k]));
  }
  ASSERT_EQ(exported.pins, read.pins);
  for (int p = 0; p < read.pins; ++p) EXPECT_TRUE(same_bits(exported.pin[p].a_at.x, read.pin[p].a_at.x));
  EXPECT_EQ(exported.loads, read.loads);
  EXPECT_EQ(exported.springs, read.springs);
  EXPECT_TRUE(same_bits(exported.gravity.y, read.gravity.y));
}

TEST(SceneFile, ExportsBitForBit) {
  expect_same(crank_rocker, "crank_rocker");
  expect_same(gantry, "gantry");
  expect_same(squeezer, "squeezer");
  static_assert(crank_rocker_index::body_crank == 1);
  static_assert(crank_rocker_index::coordinate_crank == 1);
  static_assert(gantry_index::coordinate_ram == 3);
  static_assert(gantry_index::contact_column == 2);
}

}  // namespace
}  // namespace slideway::io
