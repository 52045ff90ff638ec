// The slideway command: exit status, messages, files.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "support/command.hpp"

namespace {

using nlohmann::json;
using namespace test;

const fs::path source_dir = SLIDEWAY_SOURCE_DIR;
const fs::path defects_dir = source_dir / "tests/data/defects";

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> list;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) list.push_back(line);
  return list;
}
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) list.push_back(cell);
  return list;
}
void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size()) text.replace(at, what.size(), by);
}

class Command : public CommandTest {
 protected:
  Result slideway(const std::string& arguments, const fs::path& directory = defects_dir) const {
    return CommandTest::slideway(arguments, directory);
  }
  json run(const std::string& arguments) const {
    const Result result = slideway("run " + arguments + " --quiet --json $TMP/run.json");
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.err;
    return json::parse(read(tmp / "run.json"));
  }
  void make_hostile_files() const;
};

struct Case {
  std::string arguments;
  std::vector<std::string> messages;
};

/// tests/data/defects/cases.txt; its head says how it is written.
std::vector<Case> defect_cases() {
  std::vector<Case> cases;
  for (const std::string& line : lines(read(defects_dir / "cases.txt"))) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] != ' ') {
      cases.push_back({line, {}});
    } else {
      cases.back().messages.push_back(line.substr(line.find_first_not_of(' ')));
    }
  }
  return cases;
}

bool matches(const std::string& line, const std::string& wanted) {
  const bool open_end = wanted.size() >= 3 && wanted.substr(wanted.size() - 3) == "...";
  return open_end ? line.compare(0, wanted.size() - 3, wanted, 0, wanted.size() - 3) == 0 : line == wanted;
}

void Command::make_hostile_files() const {
  const std::string name = "name = \"broken\"\n";
  const auto bodies = [&](int count, const std::string& joint) {
    std::string text = name;
    for (int i = 0; i < count; ++i) {
      text += "[[body]]\nname = \"b" + std::to_string(i) + "\"\nparent = \"ground\"\njoint = \"" + joint +
              "\"\nmass = 1.0\ninertia = 1.0\n";
    }
    return text;
  };
  std::string keys;
  for (int i = 0; i < 100000; ++i) keys += "a.";
  write(tmp / "empty.toml", "");
  write(tmp / "blank.toml", " \n\t\n");
  write(tmp / "binary.toml", name + std::string("\0\1\2\3", 4));
  write(tmp / "not_utf8.toml", name + "# \xff\xfe\n");
  write(tmp / "big.toml", read(defects_dir / "fine.toml") + std::string(10'000'000, '#'));
  write(tmp / "deep_array.toml", name + "x = " + std::string(10000, '['));
  write(tmp / "deep_keys.toml", name + keys + "a = 1\n");
  write(tmp / "many_bodies.toml", bodies(65, "revolute"));
  write(tmp / "many_coordinates.toml", bodies(22, "planar"));
}

TEST_F(Command, RefusesEveryBrokenSceneAndCommandLine) {
  make_hostile_files();
  const std::vector<Case> cases = defect_cases();
  EXPECT_GE(cases.size(), 40u);
  for (const Case& one : cases) {
    SCOPED_TRACE(one.arguments);
    Result result = slideway(one.arguments);
    replace_all(result.err, tmp.string(), "$TMP");
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    const std::vector<std::string> said = lines(result.err);
    const bool good = std::equal(said.begin(), said.end(), one.messages.begin(), one.messages.end(), matches);
    EXPECT_TRUE(good) << result.err;
  }
}

TEST_F(Command, TellsItsVersionAndItsVerbs) {
  EXPECT_EQ(slideway("--version").out, "slideway " SLIDEWAY_VERSION "\n");
  EXPECT_EQ(slideway("").status, 2);
  const Result help = slideway("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* verb : {"run", "lint", "export", "scenes"}) EXPECT_NE(help.out.find(verb), help.out.npos);
}

TEST_F(Command, HandsChartsToTheProgramBesideIt) {
  fs::copy(SLIDEWAY_COMMAND, tmp / "slideway");
  const Result alone = shell("PATH=/nowhere ./slideway chart slider_crank -o out", tmp);
  EXPECT_EQ(alone.status, 2);
  EXPECT_EQ(
      alone.err,
      "slideway chart: slideway-charts is neither beside this program nor on the path (No such file or directory);"
      " ./dev charts builds it\n");
  write(tmp / "slideway-charts", "#!/bin/sh\necho \"$0: $@\"\nexit 1\n");
  fs::permissions(tmp / "slideway-charts", fs::perms::owner_all);
  const Result handed = shell("./slideway atlas --help baumgarte -o 'a b'", tmp);
  EXPECT_EQ(handed.status, 1);
  EXPECT_EQ(handed.out, (tmp / "slideway-charts").string() + ": atlas --help baumgarte -o a b\n");
}

TEST_F(Command, ListsEveryShippedSceneWithWhatItIs) {
  const std::vector<std::string> list = lines(slideway("scenes").out);
  std::size_t shipped = 0;
  for (const auto& entry : fs::directory_iterator(source_dir / "scenes"))
    shipped += entry.path().extension() == ".toml";
  EXPECT_EQ(list.size(), shipped);
  for (const std::string& line : list) EXPECT_GT(line.size(), 40u) << line;
}

TEST_F(Command, LintsAndExportsEveryShippedScene) {
  for (const std::string& line : lines(slideway("scenes").out)) {
    const std::string scene = line.substr(0, line.find(' '));
    EXPECT_EQ(slideway("lint " + scene).status, 0) << scene;
    const Result header = slideway("export -o - " + scene);
    EXPECT_EQ(header.status, 0) << header.err;
    EXPECT_NE(header.out.find("static_assert(slideway::defects(" + scene + ").count == 0)"), header.out.npos) << scene;
  }
}

TEST_F(Command, TakesAFileBeforeAShippedSceneOfItsName) {
  const std::string one_step = " --quiet --dt 0.5 --duration 0.5 --json - ";
  write(tmp / "gantry", read(defects_dir / "fine.toml"));
  EXPECT_EQ(json::parse(slideway("run gantry" + one_step, tmp).out)["scene"], "fine");
  EXPECT_EQ(json::parse(slideway("run gantry" + one_step).out)["scene"], "gantry");
  EXPECT_EQ(json::parse(slideway("run -" + one_step + "<fine.toml").out)["scene"], "fine");
}

TEST_F(Command, HoldsJsonDocumentsToTheirSchemas) {
  const std::string quietly = " --quiet --json $TMP/";
  slideway("run crank_rocker" + quietly + "run1.json");
  slideway("run squeezer --duration 1e-4" + quietly + "run2.json");
  slideway("run gantry --set guide.beam.mu=0.2 --method kinematic" + quietly + "run3.json");
  slideway("run two_inputs.toml --input push=1 --input twist=0" + quietly + "run4.json");
  slideway("run at_rest.toml" + quietly + "run5.json");
  slideway("run belt --method rk4_located --dt 0.01" + quietly + "run6.json");
  slideway("run belt --method moreau --theta 1 --stabilise projection --dt 0.01" + quietly + "run7.json");
  slideway("lint crank_rocker --json $TMP/lint1.json");
  slideway("lint gantry --json $TMP/lint2.json");
  hold_to_schema("run", "run*.json");
  hold_to_schema("lint", "lint*.json");
}

TEST_F(Command, RepeatsItselfButForTheTimeItTook) {
  const std::string arguments = "crank_rocker --csv $TMP/";
  json first = run(arguments + "first.csv"), second = run(arguments + "second.csv");
  EXPECT_GT(first["ns_per_step"], 0);
  first.erase("ns_per_step");
  second.erase("ns_per_step");
  EXPECT_EQ(first, second);
  EXPECT_EQ(read(tmp / "first.csv"), read(tmp / "second.csv"));
}

TEST_F(Command, NamesTheColumnsAfterTheScene) {
  const auto header = [&](const std::string& scene) {
    return lines(slideway("run " + scene + " --quiet --dt 1e-6 --duration 1e-6 --csv -").out).at(0);
  };
  EXPECT_EQ(
      header("crank_rocker"),
      "t,q.rocker,q.crank,v.rocker,v.crank,lambda.slot.0,friction.slot,slip.slot,mode.slot,drive.motor,energy,work,"
      "dissipated,constraint_work,drift");
  EXPECT_EQ(
      header("gantry"),
      "t,q.carriage.x,q.carriage.y,q.carriage.angle,q.ram.x,q.ram.y,q.ram.angle,v.carriage.x,v.carriage.y,"
      "v.carriage.angle,v.ram.x,v.ram.y,v.ram.angle,lambda.beam.0,lambda.beam.1,lambda.column.0,lambda.column.1,"
      "friction.beam,friction.column,slip.beam,slip.column,mode.beam,mode.column,drive.along,drive.down,energy,work,"
      "dissipated,constraint_work,drift");
  EXPECT_EQ(header("squeezer"),
            "t,q.K1,q.K2,q.K3,q.K5,q.K4,q.K7,q.K6,v.K1,v.K2,v.K3,v.K5,v.K4,v.K7,v.K6,pin.E3.x,pin.E3.y,pin.E4.x,"
            "pin.E4.y,pin.E6.x,pin.E6.y,energy,work,dissipated,constraint_work,drift");
}

TEST_F(Command, WritesTheFirstEveryNthAndTheLastRow) {
  const std::string arguments = "run crank_rocker --quiet --dt 1e-3 --duration 0.0255 --every 10 --csv -";
  const std::vector<std::string> rows = lines(slideway(arguments).out);
  ASSERT_EQ(rows.size(), 5u);
  const double times[] = {0, 0.01, 0.02, 0.0255};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(std::stod(rows[i + 1]), times[i]);
  const std::size_t columns = cells(rows[0]).size();
  for (const std::string& row : rows) EXPECT_EQ(cells(row).size(), columns);
}

TEST_F(Command, EndsAtTheDuration) {
  for (const char* duration : {"0.1", "0.0255", "0.3", "1e-4", "0.7"}) {
    const json document = run(std::string("crank_rocker --dt 1e-3 --duration ") + duration);
    const double wanted = std::stod(duration);
    EXPECT_NEAR(document["t"].get<double>(), wanted, 4e-16 * std::fmax(1, wanted)) << duration;
    EXPECT_EQ(document["steps"].get<double>(), std::ceil(wanted / 1e-3 - 1e-9)) << duration;
  }
}

TEST_F(Command, CsvAgreesWithTheDocument) {
  const json document = run("crank_rocker --csv $TMP/t.csv");
  const std::vector<std::string> last = cells(lines(read(tmp / "t.csv")).back());
  EXPECT_EQ(std::stod(last.at(0)), document["t"]);
  EXPECT_EQ(std::stod(last.at(1)), document["final"]["q"]["rocker"][0]);
  EXPECT_EQ(std::stod(last.at(5)), document["reactions"]["lambda"]["slot"][0]);
  EXPECT_EQ(std::stod(last.at(9)), document["reactions"]["drive"]["motor"]);
  EXPECT_EQ(std::stod(last.at(10)), document["energy"]["final"]);
}

TEST_F(Command, SendsTheTableWhereItDoesNoHarm) {
  const Result plain = slideway("run crank_rocker --duration 0.01");
  EXPECT_NE(plain.out.find("crank_rocker: 3 bodies"), plain.out.npos);
  EXPECT_EQ(plain.err, "");
  const Result piped = slideway("run crank_rocker --duration 0.01 --json -");
  EXPECT_TRUE(json::accept(piped.out));
  EXPECT_NE(piped.err.find("crank_rocker: 3 bodies"), piped.err.npos);
  const Result quiet = slideway("run crank_rocker --duration 0.01 --quiet");
  EXPECT_EQ(quiet.out + quiet.err, "");
}

// When the block of scenes/belt.toml slips and sticks.
TEST_F(Command, ListsEvents) {
  const double slips = 7.3575, sticks = slips + 2.6184222465698972, slips_again = sticks + 4.905;
  const std::string located = "belt --method dop853_located --dt 0.01 --duration ";
  const json events = run(located + "16")["events"];
  ASSERT_EQ(events.size(), 3u);
  const double times[] = {slips, sticks, slips_again};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(events[i]["t"].get<double>(), times[i], 1e-11);
    EXPECT_EQ(events[i]["kind"], i == 1 ? "stick" : "slip");
  }
  const std::string table = slideway("run " + located + "16").out;
  EXPECT_NE(table.find("\nevents                       3 located: 1 stick, 2 slip\n"
                       "                        7.3575 s   top slip\n"
                       "                    9.97592225 s   top stick\n"
                       "                    14.8809222 s   top slip\n\n"),
            table.npos)
      << table;
  EXPECT_EQ(slideway("run " + located + "7").out.find("\nevents"), table.npos) << "there are none";
  const std::string long_table = slideway("run " + located + "100").out;
  EXPECT_NE(long_table.find("\nevents                      25 located: 12 stick, 13 slip\n"), table.npos) << long_table;
  EXPECT_NE(long_table.find("\n                            15 more\n"), table.npos) << long_table;
  const std::string seen = slideway("run belt --method rk4 --dt 0.01 --duration 8").out;
  EXPECT_NE(seen.find("\nevents                       1 seen after a step: 1 slip\n"
                      "                          7.36 s   top slip\n"),
            table.npos)
      << seen;
}

TEST_F(Command, FailingOutputLosesNothingElse) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Result result = slideway("run crank_rocker --csv /dev/full --json $TMP/run.json --report $TMP/report.html");
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err, "/dev/full: is incomplete, it cannot be written: No space left on device\n");
  EXPECT_NE(result.out.find("4189 steps"), result.out.npos);
  EXPECT_EQ(json::parse(read(tmp / "run.json"))["steps"], 4189);
  EXPECT_NE(read(tmp / "report.html").find("</html>"), std::string::npos);
  const Result other = slideway("run crank_rocker --quiet --csv $TMP/t.csv --json /dev/full --report /dev/full2");
  EXPECT_EQ(other.status, 2);
}

TEST_F(Command, OutputThatCannotBeOpenedLeavesTheOthersAsTheyWere) {
  write(tmp / "t.csv", "from an earlier run\n");
  const Result result = slideway("run crank_rocker --csv $TMP/t.csv --json $TMP/nowhere/run.json");
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, (tmp / "nowhere/run.json").string() + ": cannot be written: No such file or directory\n");
  EXPECT_EQ(read(tmp / "t.csv"), "from an earlier run\n");
}

TEST_F(Command, RefusalWritesWhatWasComputed) {
  const Result result = slideway(
      "run painleve_rod --set guide.wire.mu=1.5 --set 'body.rod.q=[0, 0, 1.4]' --method rk4_located --dt 0.01 --quiet "
      "--csv t.csv --json run.json --report report.html",
      tmp);  // it falls into poses where two answers exist
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err.rfind("painleve_rod: at t = 0.11 s: Several sets of contact forces", 0), 0u) << result.err;
  const std::vector<std::string> rows = lines(read(tmp / "t.csv"));
  ASSERT_EQ(rows.size(), 13u);
  EXPECT_EQ(std::stod(rows.back()), 0.11);
  EXPECT_TRUE(std::isnan(std::stod(cells(rows.back()).at(7)))) << "no contact force is known there";
  const json document = json::parse(read(tmp / "run.json"));
  EXPECT_EQ(document["status"], "not_unique");
  EXPECT_EQ(document["t"], 0.11);
  EXPECT_EQ(document["steps"], 11);
  EXPECT_EQ(document["message"].get<std::string>() + "\n", result.err);
  EXPECT_TRUE(document["reactions"]["lambda"]["wire"][0].is_null());
  EXPECT_NE(read(tmp / "report.html").find("</html>"), std::string::npos);
}

TEST_F(Command, SettingsAndInputsReachTheKernel) {
  const json rough = run("crank_rocker"), smooth = run("crank_rocker --set guide.slot.mu=0");
  EXPECT_GT(rough["energy"]["dissipated"], 1);
  EXPECT_EQ(smooth["energy"]["dissipated"], 0);
  EXPECT_EQ(smooth["settings"], json::array({"guide.slot.mu=0"}));
  EXPECT_EQ(rough["hash"], smooth["hash"]) << "of the text, which is the same";
  const json still = run("two_inputs.toml --set guide.way.mu=0 --input push=0 --input twist=0");
  const json pushed = run("two_inputs.toml --set guide.way.mu=0 --input push=3 --input twist=0");
  EXPECT_NEAR(still["final"]["v"]["block"][0], 1, 1e-12);
  EXPECT_NEAR(pushed["final"]["v"]["block"][0], 4, 1e-12) << "3 N on 1 kg for 1 s";
}

TEST_F(Command, GainsAndMethodsReachTheKernel) {
  EXPECT_EQ(run("crank_rocker --alpha 7 --beta 9")["alpha"], 7);
  const std::string long_run = "slider_crank_driven --dt 0.01 --duration 20";
  const double held = run(long_run)["drift_position"];
  EXPECT_GT(run(long_run + " --alpha 0 --beta 0")["drift_position"], 10 * held);
  EXPECT_GT(run("crank_rocker --method euler --dt 1e-4")["drift_position"],
            100 * run("crank_rocker --method rk4 --dt 1e-4")["drift_position"].get<double>());
  EXPECT_LT(run("crank_rocker --method kinematic")["drift_position"], 1e-14);
}

TEST_F(Command, ProjectStartMovesTheStartOntoTheConstraints) {
  const std::string file = "start_off_line.toml ";
  EXPECT_EQ(slideway("run " + file).status, 2);
  EXPECT_LT(run(file + "--project-start")["drift_position"], 1e-15);
  EXPECT_EQ(slideway("run start_off_pin.toml --project-start").status, 1) << "no pose closes that loop";
}

TEST_F(Command, LintFindsWhatASceneDoesNotNeed) {
  const json clean = json::parse(slideway("lint elliptic_trammel --json -").out);
  EXPECT_TRUE(clean["findings"].empty());
  const Result result = slideway("lint superfluous.toml --json $TMP/lint.json");
  EXPECT_EQ(result.status, 0) << result.err;
  const json document = json::parse(read(tmp / "lint.json"));
  std::vector<std::string> items;
  for (const json& finding : document["findings"]) items.push_back(finding["item"]);
  const std::vector<std::string> wanted{"body 'slide'",
                                        "body 'ballast'",
                                        "body 'ghost'",
                                        "guide 'second'",
                                        "guide 'stacked'",
                                        "guide 'driven'",
                                        "spring 'spring1'",
                                        "joint_spring 'joint_spring1'",
                                        "joint_spring 'joint_spring2'",
                                        "load 'load1'"};
  EXPECT_EQ(items, wanted) << result.out;
  EXPECT_EQ(lines(result.out).size(), wanted.size());
}

TEST_F(Command, WhatLintSaysOfFrictionIsSo) {
  const json rough = run("crank_rocker --method kinematic"),
             smooth = run("crank_rocker --method kinematic --set guide.slot.mu=0");
  EXPECT_NEAR(rough["final"]["q"]["rocker"][0], smooth["final"]["q"]["rocker"][0], 1e-14);
  EXPECT_NEAR(rough["reactions"]["lambda"]["slot"][0], smooth["reactions"]["lambda"]["slot"][0], 1e-12);
  EXPECT_GT(std::abs(rough["reactions"]["drive"]["motor"].get<double>() -
                     smooth["reactions"]["drive"]["motor"].get<double>()),
            1);
}

}  // namespace
