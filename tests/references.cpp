// The stored references: there for every shipped scene, as they were written, and true.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <slideway/oracle/reference.hpp>

#include "support/command.hpp"

namespace {

using namespace slideway;
using namespace slideway::oracle;
namespace fs = std::filesystem;

const fs::path source = SLIDEWAY_SOURCE_DIR;

/// Shipped scenes that have no trajectory, and why.
const std::map<std::string, const char*> motionless = {
    {"three_contacts", "the third contact is redundant: nothing decides how friction slows the block"}};

/// Those that have one.
std::vector<fs::path> scenes() {
  std::vector<fs::path> files;
  for (const char* directory : {"scenes", "tests/data/scenes"}) {
    for (const auto& entry : fs::directory_iterator(source / directory)) {
      if (motionless.count(entry.path().stem().string()) == 0) files.push_back(entry.path());
    }
  }
  return files;
}

io::Json stored(const std::string& scene) {
  return io::Json::parse(test::read(source / "oracle/references" / (scene + ".json")));
}

TEST(References, AreThereForEveryShippedSceneAndFitItsText) {
  int count = 0;
  for (const fs::path& file : scenes()) {
    const auto reading = io::read_scene(file.string());
    ASSERT_TRUE(reading.scene) << file;
    const Reference reference = reference_of(stored(reading.scene->name));
    EXPECT_EQ(reference.hash, reading.scene->hash) << file << ": run ./dev references";
    EXPECT_EQ(reference.duration, reading.scene->run.duration) << file;
    EXPECT_GE(reference.digits, 30) << file;
    EXPECT_EQ(reference.trajectory.samples.size(), static_cast<std::size_t>(reference_intervals) + 1) << file;
    ++count;
  }
  EXPECT_GE(count, 27);
}

TEST(References, AreLeftOutOnlyWhereThereIsNoTrajectory) {
  for (const auto& [scene, why] : motionless) {
    const auto reading = io::read_scene((source / "scenes" / (scene + ".toml")).string());
    ASSERT_TRUE(reading.scene) << scene;
    const Reference none = make_reference(*reading.scene, [](double) {});
    EXPECT_NE(none.trajectory.end, End::duration) << scene << ": " << why;
    EXPECT_EQ(none.trajectory.t, 0) << scene;
    EXPECT_FALSE(fs::exists(source / "oracle/references" / (scene + ".json"))) << scene << ": " << why;
  }
}

TEST(References, AreRefusedWhenADigitWasChanged) {
  io::Json json = stored("crank_rocker");
  std::string number = json["samples"][3]["q"][0];
  number[5] = number[5] == '7' ? '8' : '7';
  json["samples"][3]["q"][0] = number;
  EXPECT_THROW(reference_of(json), std::runtime_error);
}

TEST(References, AreWhatIsComputedToday) {
  for (const char* name : {"crank_rocker_offset", "elliptic_trammel"}) {
    const auto reading = io::read_scene((source / "scenes" / (std::string(name) + ".toml")).string());
    const Reference old = reference_of(stored(name)), now = make_reference(*reading.scene, [](double) {});
    EXPECT_GE(shared_digits(old.trajectory, now.trajectory), 30) << name;
  }
}

TEST(References, HaveTheEnergyThatTheirWorkLeaves) {
  for (const fs::path& file : scenes()) {
    const Reference reference = reference_of(stored(file.stem().string()));
    const auto& samples = reference.trajectory.samples;
    for (const auto& s : samples) {
      const Real miss = s.energy - samples.front().energy - s.work + s.dissipated;
      EXPECT_LT(abs(miss), Real(1e-28) * (abs(s.energy) + abs(s.work) + abs(samples.front().energy) + 1)) << file;
    }
  }
}

}  // namespace
