// slideway hlcp: answers, exit status, documents, and what it says of bad problems.
#include <vector>

#include "hlcp_problem.hpp"  // the command's own judgement, with answers that the kernel does not give
#include "support/command.hpp"

namespace {

using nlohmann::json;
using namespace test;

const fs::path source_dir = SLIDEWAY_SOURCE_DIR;
const fs::path data_dir = source_dir / "tests/data/hlcp";

std::string identity(int n) {
  json rows = std::vector<std::vector<int>>(static_cast<std::size_t>(n), std::vector<int>(static_cast<std::size_t>(n)));
  for (int i = 0; i < n; ++i) rows[i][i] = 1;
  return rows.dump();
}

/// Runs in a directory of its own, $DATA being the shipped problems.
class HlcpCommand : public CommandTest {
 protected:
  Result shell(const std::string& words) const {
    return CommandTest::shell("export DATA='" + data_dir.string() + "' && " + words, tmp);
  }
  Result hlcp(const std::string& arguments) const { return shell("'" SLIDEWAY_COMMAND "' hlcp " + arguments); }
  static std::string shipped(const std::string& name) { return "$DATA/" + name; }
  /// The document of a shipped problem, which has to have this exit status.
  json document(const std::string& name, int status) const {
    const Result result = hlcp(shipped(name) + " --json " + name + ".out");
    EXPECT_EQ(result.status, status) << result.out << result.err;
    return json::parse(read(tmp / (name + ".out")));
  }
  /// The same for a problem's text, by standard input.
  json answer(const std::string& text, int status) const {
    write(tmp / "given", text);
    const Result result = hlcp("- --json - <given");
    EXPECT_EQ(result.status, status) << result.out << result.err;
    return json::parse(result.out);
  }
};

TEST_F(HlcpCommand, ShowsBothAnswersSideBySide) {
  const Result result = shell("cp " + shipped("coupled.json") + " . && '" SLIDEWAY_COMMAND "' hlcp coupled.json");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out,
            "problem        coupled.json: HLCP A+ x+ - A- x- = b of order 2\n"
            "               kernel                   exact\n"
            "answer         ok                       one solution\n"
            "uniqueness     certified                W-property holds\n"
            "solves         2\n"
            "residual       0                        2.22e-17 of this x\n"
            "x[0]           0.41666666666666669      5/12 = 0.41666666666666669\n"
            "x[1]           -0.5                     -1/2 = -0.5\n"
            "digits shared  16.4\n"
            "verdict        agree: one solution\n");
}

TEST_F(HlcpCommand, SolvesAnLcp) {
  const json found = document("kostreva.json", 0);
  EXPECT_EQ(found["kind"], "lcp");
  EXPECT_EQ(found["order"], 3);
  EXPECT_EQ(found["status"], "ok");
  EXPECT_EQ(found["uniqueness"], "certified");
  EXPECT_EQ(found["w_property"], true);
  EXPECT_EQ(found["continuum"], false);
  ASSERT_EQ(found["solutions"].size(), 1u);
  EXPECT_EQ(found["solutions"][0]["exact"], json::array({"-1/3", "-1/3", "-1/3"}));
  EXPECT_EQ(found["solutions"][0]["double"], json::array({-1.0 / 3, -1.0 / 3, -1.0 / 3}));
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(found["x"][k], -1.0 / 3, 1e-15);
    EXPECT_EQ(found["z"][k].get<double>(), -found["x"][k].get<double>());
    EXPECT_EQ(found["w"][k], 0);
  }
  EXPECT_LE(found["distance"], 1e-15);
}

TEST_F(HlcpCommand, ReadsSiconosFilesColumnByColumn) {
  const json found = document("cps_4.dat", 0);
  EXPECT_EQ(found["kind"], "lcp");
  EXPECT_EQ(found["uniqueness"], "single");
  EXPECT_EQ(found["w_property"], false);
  ASSERT_EQ(found["solutions"].size(), 1u);
  EXPECT_EQ(found["solutions"][0]["exact"], json::array({"-2", "-2", "-2", "-92"})) << "row by row there is none";
  const json same = answer(read(data_dir / "cps_4.dat"), 0);
  EXPECT_EQ(same["solutions"], found["solutions"]);
  EXPECT_EQ(same["hash"], found["hash"]);
  EXPECT_EQ(same["problem"], "-");
}

TEST_F(HlcpCommand, AgreesThatThereIsNoSolution) {
  const json found = document("painleve_klein_none.json", 0);
  EXPECT_EQ(found["status"], "no_solution");
  EXPECT_TRUE(found["x"].is_null());
  EXPECT_TRUE(found["residual"].is_null());
  EXPECT_EQ(found["solutions"], json::array());
  EXPECT_EQ(found["verdict"], "agree: no solution");
}

TEST_F(HlcpCommand, AgreesThatThereAreTwo) {
  const json found = document("painleve_klein.json", 0);
  EXPECT_EQ(found["status"], "not_unique");
  EXPECT_EQ(found["uniqueness"], "refuted");
  EXPECT_EQ(found["solutions"], json::parse(R"([{"exact": ["1"], "double": [1.0]},
                                                {"exact": ["-1/5"], "double": [-0.2]}])"));
  EXPECT_EQ(found["continuum"], false);
}

TEST_F(HlcpCommand, AgreesThatThereIsAContinuum) {
  const json found = document("line.json", 0);
  EXPECT_EQ(found["status"], "not_unique");
  EXPECT_EQ(found["continuum"], true);
  EXPECT_EQ(found["solutions"], json::array());
  EXPECT_NE(hlcp(shipped("line.json")).out.find("vertex 2 of 2\n"), std::string::npos);
}

/// Two solutions of one unknown among three: the other two go, and the numbers become short.
TEST_F(HlcpCommand, MakesAProblemSmallThatHasTheSameVerdict) {
  std::ofstream(tmp / "large.json") << R"({"A_plus": [[3.1, 0.2, 0.1], [0.3, -1.234, 0], [0.1, 0, 2.7]],
      "A_minus": [[2.9, 0.1, 0], [0.2, 5.678, 0.1], [0, 0.1, 2.2]], "b": [0.5, -1.03, 0.25]})";
  const Result large = hlcp("large.json --shrink small.json");
  EXPECT_EQ(large.status, 0) << large.err;
  EXPECT_NE(large.out.find("agree: 2 solutions"), std::string::npos) << large.out;
  const json small = json::parse(read(tmp / "small.json"));
  EXPECT_EQ(small["b"].size(), 1u) << small;
  EXPECT_LE(small.dump().size(), 50u) << small;
  EXPECT_NE(hlcp("small.json").out.find("agree: 2 solutions"), std::string::npos);
  const Result onto_itself = hlcp("large.json --shrink large.json");
  EXPECT_EQ(onto_itself.status, 2);
  EXPECT_EQ(onto_itself.err, "large.json: is the problem itself: write to another file\n");
}

TEST_F(HlcpCommand, SaysWhatItDoesNotCheckAboveOrderTwelve) {
  const json found = document("murty_13.json", 0);
  EXPECT_EQ(found["status"], "ok");
  for (const char* key : {"w_property", "solutions", "continuum", "distance"}) EXPECT_TRUE(found[key].is_null()) << key;
  EXPECT_EQ(found["x"][0], -1);
  EXPECT_EQ(found["x"][12], 1);
  EXPECT_EQ(found["verdict"],
            "the answer's x satisfies the equations; above order 12 its uniqueness (unproven) is not checked");
  json none = {{"M", json::parse(identity(13))}, {"q", std::vector<int>(13, -1)}};
  for (int k = 0; k < 13; ++k) none["M"][k][k] = -1;  // w + z = -1
  const json refused = answer(none.dump(), 1);
  EXPECT_EQ(refused["agree"], false);
  EXPECT_NE(refused["status"], "ok");
}

TEST_F(HlcpCommand, ReportsWhatTheKernelDoesNotDecide) {
  const json found = answer(R"({"A_plus": [[1e-300]], "A_minus": [[1e-300]], "b": [1e300]})", 1);
  EXPECT_EQ(found["status"], "inaccurate");
  EXPECT_EQ(found["agree"], false);
  EXPECT_EQ(found["verdict"], "nothing is said of this problem: inaccurate");
  ASSERT_EQ(found["solutions"].size(), 1u);
  EXPECT_TRUE(found["solutions"][0]["double"][0].is_null()) << "1e600";
  EXPECT_EQ(found["w_property"], true);
}

TEST_F(HlcpCommand, ListsAtMostEightSolutionsButWritesAll) {
  const json found =
      answer(R"({"M": [[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, -1]], "q": [1, 1, 1, 1]})", 0);
  EXPECT_EQ(found["solutions"].size(), 16u);
  const std::string table = read(tmp / "stderr");
  EXPECT_NE(table.find("solution 8 of 16\n"), table.npos);
  EXPECT_EQ(table.find("solution 9 of 16\n"), table.npos);
  EXPECT_NE(table.find("and 8 more: --json FILE has all\n"), table.npos);
}

TEST_F(HlcpCommand, HoldsItsDocumentsToTheSchema) {
  ASSERT_EQ(shell("python3 -c 'import jsonschema'").status, 0) << "this test needs Debian's python3-jsonschema";
  int documents = 0;
  for (const auto& entry : fs::directory_iterator(data_dir)) {
    document(entry.path().filename().string(), 0);
    ++documents;
  }
  EXPECT_GE(documents, 7);
  write(tmp / "inaccurate.json.out",
        answer(R"({"A_plus": [[1e-300]], "A_minus": [[1e-300]], "b": [1e300]})", 1).dump());
  json largest = {{"M", json::parse(identity(64))}, {"q", std::vector<int>(64)}};
  for (int k = 0; k < 64; ++k) largest["q"][k] = k % 2 != 0 ? -k : k;
  largest = answer(largest.dump(), 0);
  EXPECT_EQ(largest["order"], 64);
  EXPECT_EQ(largest["x"][63], -63);
  write(tmp / "largest.json.out", largest.dump());
  write(tmp / "hold.py", R"(import json, sys
import jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
for name in sys.argv[2:]:
    document = json.load(open(name))
    jsonschema.validate(document, schema, cls=jsonschema.Draft202012Validator)
    document['z'] = document.pop('x')
    assert not jsonschema.Draft202012Validator(schema).is_valid(document), 'without x, and of an HLCP with z'
)");
  const Result held = shell("python3 hold.py '" + (source_dir / "docs/schema/hlcp.schema.json").string() + "' *.out");
  EXPECT_EQ(held.status, 0) << held.err;
}

// ---- Answers that are wrong

using slideway::Status;
using slideway::Uniqueness;
using slideway::properties::HlcpCheck;

/// Of A+ x+ - A- x- = b of order 1, when the answer says this.
HlcpCheck judge(double plus, double minus, double b, Status status, double x, Uniqueness uniqueness) {
  slideway::properties::HlcpCase problem;
  problem.n = 1;
  problem.data.plus[0][0] = plus;
  problem.data.minus[0][0] = minus;
  problem.data.b[0] = b;
  slideway::properties::HlcpAnswer kernel = {};
  kernel.status = status;
  kernel.x[0] = x;
  kernel.uniqueness = uniqueness;
  return slideway::properties::check_hlcp(problem, kernel);
}

void expect_disagreement(const HlcpCheck& check, const std::string& verdict) {
  EXPECT_FALSE(check.agree());
  EXPECT_EQ(check.verdict, verdict);
}

TEST(HlcpVerdict, DisagreesWithASolutionThatIsNone) {
  expect_disagreement(judge(3, 1, 1, Status::ok, 0.25, Uniqueness::certified),
                      "disagree: the answer's x misses an equation by 0.14 of its terms, and promised 1.1e-15");
  expect_disagreement(judge(-1, 5, 1, Status::ok, 1, Uniqueness::unproven),
                      "disagree: the answer's x misses an equation by 1 of its terms, and promised 1.1e-15");
  EXPECT_TRUE(judge(3, 1, 1, Status::ok, 1.0 / 3, Uniqueness::certified).agree());
  EXPECT_TRUE(judge(1, 1, 1, Status::ok, 1 + 10 * 0x1p-52, Uniqueness::certified).agree()) << "10 of 10";
  EXPECT_FALSE(judge(1, 1, 1, Status::ok, 1 + 11 * 0x1p-52, Uniqueness::certified).agree()) << "11 of 10";
}

TEST(HlcpVerdict, DisagreesWithASolutionWhereRoundingHidesThatThereIsNone) {
  // 1 x+ = 1 and (1 + 2^-52) x+ = 1 contradict; x = 1 misses the second by 2^-53 of its terms.
  slideway::properties::HlcpCase problem;
  problem.n = 2;
  for (int i = 0; i < 2; ++i) problem.data.b[i] = problem.data.plus[i][0] = problem.data.minus[i][0] = 1;
  problem.data.plus[1][0] = problem.data.minus[1][0] = 1 + 0x1p-52;
  slideway::properties::HlcpAnswer kernel = {};
  kernel.x[0] = 1;
  kernel.uniqueness = Uniqueness::unproven;
  expect_disagreement(slideway::properties::check_hlcp(problem, kernel),
                      "disagree: the answer has a solution; exact: no solution");
}

TEST(HlcpVerdict, DisagreesWithAFalseClaimOfUniqueness) {
  expect_disagreement(judge(-1, 5, -1, Status::ok, 1, Uniqueness::certified),
                      "disagree: the answer says certified; exact: 2 solutions, the W-property does not hold");
  expect_disagreement(judge(-1, 5, -1, Status::ok, 1, Uniqueness::single),
                      "disagree: the answer says single; exact: 2 solutions, the W-property does not hold");
  expect_disagreement(judge(3, 1, 1, Status::ok, 1.0 / 3, Uniqueness::single),
                      "disagree: the answer says single; exact: one solution, the W-property holds");
  expect_disagreement(judge(3, 1, 1, Status::ok, 1.0 / 3, Uniqueness::refuted),
                      "disagree: the answer says refuted; exact: one solution, the W-property holds");
  EXPECT_TRUE(judge(-1, 5, -1, Status::ok, 1, Uniqueness::refuted).agree());
  EXPECT_TRUE(judge(-1, 5, -1, Status::ok, 1, Uniqueness::unproven).agree());
  EXPECT_TRUE(judge(-1, 5, 0, Status::ok, 0, Uniqueness::single).agree());
}

TEST(HlcpVerdict, DisagreesWithARefusalWithoutCause) {
  expect_disagreement(judge(3, 1, 1, Status::no_solution, 0, Uniqueness::unproven),
                      "disagree: the answer says no_solution; exact: one solution");
  expect_disagreement(judge(-1, 5, 1, Status::not_unique, 0, Uniqueness::refuted),
                      "disagree: the answer says not_unique; exact: no solution");
  expect_disagreement(judge(0, 1, 0, Status::no_solution, 0, Uniqueness::unproven),
                      "disagree: the answer says no_solution; exact: a continuum of solutions");
  EXPECT_TRUE(judge(0, 1, 0, Status::not_unique, 0, Uniqueness::refuted).agree());
}

// ---- Bad problems

struct Bad {
  const char* file;
  std::string text, message;
};

const std::string forms =
    R"(write {"A_plus": [[..]], "A_minus": [[..]], "b": [..]} or, for w - M z = q, {"M": [[..]], "q": [..]})";
const std::string layout = "a Siconos file has n, 0, n, n, n, n, then M column by column, then q";

std::vector<Bad> bad_problems() {
  return {
      {"list.json", "[[1]]", ": is not a problem: " + forms},
      {"nothing.json", "{}", ": is not a problem: " + forms},
      {"no_b.json", R"({"A_plus": [[1]], "A_minus": [[1]]})", ": has no b: " + forms},
      {"both.json", R"({"A_plus": [[1]], "A_minus": [[1]], "b": [1], "q": [1]})", ": has both A_plus and q: " + forms},
      {"key.json", R"({"A_pluss": [[1]], "A_minus": [[1]], "b": [1]})",
       ": unknown key 'A_pluss'; did you mean 'A_plus'?"},
      {"other_key.json", R"({"matrix": [[1]], "q": [1]})",
       ": unknown key 'matrix'; there are: A_plus, A_minus, b, M, q"},
      {"twice.json", R"({"M": [[1]], "q": [1], "q": [2]})", ": has the key 'q' twice"},
      {"square.json", R"({"M": [[1, 2], [3, 4, 5]], "q": [1, 2]})", ": M[1] has 3 numbers, and M has 2 rows: write 2"},
      {"tall.json", R"({"M": [[1], [3]], "q": [1, 2]})", ": M[0] has 1 numbers, and M has 2 rows: write 2"},
      {"orders.json", R"({"A_plus": [[1]], "A_minus": [[1, 0], [0, 1]], "b": [1]})",
       ": A_plus has 1 rows and A_minus 2: write matrices of one order"},
      {"length.json", R"({"M": [[1]], "q": [1, 2]})", ": q has 2 numbers, and the order is 1: write 1"},
      {"text.json", R"({"M": [[1, "2"], [0, 1]], "q": [1, 2]})", ": M[0][1] must be a number, not string"},
      {"null.json", R"({"M": [[1]], "q": [null]})", ": q[0] must be a number, not null"},
      {"row.json", R"({"M": [1], "q": [1]})", ": M[0] must be a list of numbers, not number"},
      {"rows.json", R"({"M": 1, "q": [1]})", ": M must be a list of rows, [[..], [..]], not number"},
      {"right.json", R"({"M": [[1]], "q": 1})", ": q must be a list of numbers, not number"},
      {"infinite.json", R"({"M": [[1e999]], "q": [1]})", ": has a number beyond the range of doubles, 1.8e308"},
      {"empty_matrix.json", R"({"M": [], "q": []})", ": M has order 0; the kernel takes orders 1 to 64"},
      {"large.json", R"({"q": [], "M": )" + identity(65) + "}", ": M has order 65; the kernel takes orders 1 to 64"},
      {"comma.json", "{\n \"M\": [[1]],\n \"q\": [1],\n}\n", ":4: is not JSON: syntax error while parsing ..."},
      {"open.json", "{\n\"M\n\": [[1]]}", ":2: is not JSON: syntax error while parsing ..."},
      {"nan.json", R"({"M": [[NaN]], "q": [1]})", ":1: is not JSON: syntax error while parsing ..."},
      {"empty.json", "", ":1: is not JSON: syntax error while parsing ..."},
      {"deep.json", std::string(500000, '['), ":1: is not JSON: syntax error while parsing ..."},
      {"huge.json", std::string((1 << 20) + 1, ' '), ": has more than 1024 KiB..."},
      {"short.dat", "2 0 2 2 2 2\n1 0 0 1\n3\n", ": ends before q[1]; " + layout},
      {"plain.dat", "2\n1 0\n0 1\n3 4\n", ":2: the storage type is 1, not 0 (dense); " + layout},
      {"sizes.dat", "2 0 2\n3 2 3\n", ":2: M has 3 columns, and n is 2; " + layout},
      {"order.dat", "2.5 0", ":1: n is 2.5; the kernel takes orders 1 to 64"},
      {"order_0.dat", "\n\n0", ":3: n is 0; the kernel takes orders 1 to 64"},
      {"order_65.dat", "65 0", ":1: n is 65; the kernel takes orders 1 to 64"},
      {"word.dat", "1 0 1 1 1 1\r\n1 x1\n", ":2: q[0] must be a number, not 'x1'"},
      {"infinite.dat", "1 0 1 1 1 1\n1e999 1\n", ":2: M[0][0] is '1e999', beyond the range of doubles"},
      {"not_a_number.dat", "1 0 1 1 1 1 nan 1\n", ":1: M[0][0] is 'nan', beyond the range of doubles"},
      {"empty.dat", "", ": ends before n; " + layout},
  };
}

TEST_F(HlcpCommand, RefusesEveryBadProblemInOneLine) {
  for (const Bad& bad : bad_problems()) {
    SCOPED_TRACE(bad.file);
    write(tmp / bad.file, bad.text);
    const Result result = hlcp(std::string(bad.file) + " --json out.json");
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    const std::string wanted = bad.file + bad.message;
    const bool open_end = wanted.ends_with("...");
    if (open_end) {
      EXPECT_EQ(result.err.substr(0, wanted.size() - 3), wanted.substr(0, wanted.size() - 3));
      EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
    } else {
      EXPECT_EQ(result.err, wanted + "\n");
    }
    EXPECT_FALSE(fs::exists(tmp / "out.json"));
  }
}

TEST_F(HlcpCommand, RefusesFilesThatItCannotReadOrWrite) {
  EXPECT_EQ(hlcp("nowhere.json").err, "nowhere.json: cannot be read: No such file or directory\n");
  EXPECT_EQ(hlcp(".").err, ".: is a directory; name a file in it\n");
  write(tmp / "line.json", read(data_dir / "line.json"));
  const Result onto_itself = hlcp("line.json --json ./line.json");
  EXPECT_EQ(onto_itself.status, 2);
  EXPECT_EQ(onto_itself.err, "./line.json: is the problem itself: write to another file\n");
  EXPECT_EQ(read(tmp / "line.json"), read(data_dir / "line.json"));
  const Result unwritable = hlcp("line.json --json nowhere/out.json");
  EXPECT_EQ(unwritable.status, 2);
  EXPECT_EQ(unwritable.err, "nowhere/out.json: cannot be written: No such file or directory\n");
  EXPECT_EQ(hlcp("").status, 2);
}

}  // namespace
