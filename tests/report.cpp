// The report is loaded by a real browser, which finds no error in it and nothing to fetch.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;

/// A directory of its own, removed at the end.
struct Directory {
  fs::path path;
  Directory() {
    std::string pattern = (fs::temp_directory_path() / "slideway_report_XXXXXX").string();
    path = ::mkdtemp(pattern.data());
  }
  ~Directory() { fs::remove_all(path); }
};

std::string output_of(const std::string& command) {
  std::string output;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 1 << 16> block;
  for (std::size_t size; (size = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    output.append(block.data(), size);
  ::pclose(pipe);
  return output;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The report of `slideway` with these arguments.
std::string report_of(const Directory& directory, const std::string& arguments) {
  const fs::path file = directory.path / "report.html";
  // From there, since a file with a shipped scene's name comes first, and test programs have such names.
  output_of("cd '" + directory.path.string() + "' && '" SLIDEWAY_COMMAND "' " + arguments + " --quiet --report '" +
            file.string() + "' 2>&1");
  return text_of(file);
}

bool browser_is_here() { return std::system("command -v chromium > /dev/null 2>&1") == 0; }

/// The page's document after its scripts have run, in a window of this width.
std::string document_of(const Directory& directory, const std::string& page, int width) {
  const fs::path file = directory.path / "page.html";
  std::ofstream(file) << page;
  return output_of(
      "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync --user-data-dir='" +
      (directory.path / "profile").string() + "' --window-size=" + std::to_string(width) +
      ",1000 --virtual-time-budget=5000 --dump-dom 'file://" + file.string() + "' 2> /dev/null");
}

std::string attribute(const std::string& document, const std::string& name) {
  std::smatch match;
  const std::string head = document.substr(0, 4000);
  return std::regex_search(head, match, std::regex("<html[^>]* " + name + "=\"([^\"]*)\"")) ? match[1].str() : "";
}

/// What a page draws.
nlohmann::json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

class Report : public testing::TestWithParam<const char*> {};

TEST_P(Report, IsDrawnWithoutAnError) {
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const Directory directory;
  const std::string page = report_of(directory, GetParam());
  ASSERT_FALSE(page.empty());
  for (const int width : {400, 1600}) {
    const std::string document = document_of(directory, page, width);
    EXPECT_EQ(attribute(document, "data-ready"), "ok") << width << " px";
    EXPECT_NE(attribute(document, "data-charts").find("energy"), std::string::npos) << width << " px";
    EXPECT_NE(document.find("<canvas"), std::string::npos) << "charts are drawn, " << width << " px";
    EXPECT_NE(document.find("<svg"), std::string::npos) << "the mechanism is drawn, " << width << " px";
  }
}

TEST_P(Report, FetchesNothing) {
  const Directory directory;
  const std::string page = report_of(directory, GetParam());
  ASSERT_FALSE(page.empty());
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"?https?:")));
  EXPECT_EQ(page.find("@import"), std::string::npos);
}

// Smooth, several guides, pins and a spring alone, many contacts.
INSTANTIATE_TEST_SUITE_P(Runs, Report,
                         testing::Values("run crank_rocker", "run quick_return", "run squeezer",
                                         "run v_engine_16 --duration 5e-3"),
                         [](const auto& run) {
                           const std::string arguments = run.param;
                           const auto scene = arguments.find(' ') + 1;
                           return arguments.substr(scene, arguments.find(' ', scene) - scene);
                         });

// Slips and sticks in closed form: see scenes/belt.toml.
TEST(ReportStrips, HaveTheModesAtTheTimesOfTheEvents) {
  const double slips = 7.3575, sticks = slips + 2.6184222465698972, slips_again = sticks + 4.905;
  const Directory directory;
  const std::string page = report_of(directory, "run belt --duration 16 --method rk4_located");
  const nlohmann::json data = data_of(page), &modes = data["modes"], &events = data["events"];
  ASSERT_EQ(modes.size(), 1u);
  ASSERT_EQ(modes[0].size(), 4u);
  ASSERT_EQ(events.size(), 3u);
  const double times[] = {0, slips, sticks, slips_again};
  const char* kinds[] = {"", "slip", "stick", "slip"};
  const int wanted[] = {0, -1, 0, -1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(modes[0][i][0].get<double>(), times[i], 1e-7);
    EXPECT_EQ(modes[0][i][1], wanted[i]);
    if (i == 0) continue;
    EXPECT_EQ(modes[0][i][0], events[i - 1][0]);
    EXPECT_EQ(events[i - 1][2], kinds[i]);
  }
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const std::string document = document_of(directory, page, 400);
  EXPECT_EQ(attribute(document, "data-ready"), "ok");
  EXPECT_EQ(attribute(document, "data-charts").rfind("modes slip", 0), 0u) << "and no strip of uniqueness";
  EXPECT_NE(document.find(">top: slips − 23.4 %, rests 76.6 %<"), std::string::npos);
  EXPECT_NE(document.find(">slip, 2<"), std::string::npos);
  EXPECT_NE(document.find("located times of events"), std::string::npos);
}

TEST(ReportStrips, SeeModesAfterAStepWhereEventsAreNotLocated) {
  const Directory directory;
  const nlohmann::json data = data_of(report_of(directory, "run belt --duration 10 --dt 0.01 --method rk4"));
  const nlohmann::json& spans = data["modes"][0];
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_NEAR(spans[1][0].get<double>(), 7.3575 + 0.005, 0.0051);
  EXPECT_EQ(spans[1][0], data["events"][0][0]);
  EXPECT_EQ(spans[0][1], 0);
  EXPECT_EQ(spans[1][1], -1);
  EXPECT_EQ(spans[2][1], 0);
}

TEST(ReportStrips, ShowWhereUniquenessIsNotCertified) {
  const Directory directory;
  const std::string page = report_of(directory, "run trammel_at_rest --duration 0.1");
  const nlohmann::json data = data_of(page), from_the_start = {{0.0, "motion_only"}};
  EXPECT_EQ(data["uniqueness"], from_the_start);
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const std::string document = document_of(directory, page, 400);
  EXPECT_EQ(attribute(document, "data-ready"), "ok");
  EXPECT_EQ(attribute(document, "data-charts").rfind("modes uniqueness slip", 0), 0u);
  EXPECT_NE(document.find(">forces: motion only 100 %<"), std::string::npos);
}

TEST(ReportOfARefusal, SaysWhy) {
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const Directory directory;
  const std::string page = report_of(directory, "run overhung_slider --set guide.way.mu=0.9");  // refused at once
  const std::string document = document_of(directory, page, 800);
  EXPECT_EQ(attribute(document, "data-ready"), "ok");
  EXPECT_NE(document.find("contact forces satisfy the equations"), std::string::npos);
}

TEST(ReportOfAVerification, IsDrawnWithoutAnErrorAndFetchesNothing) {
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const Directory directory;
  const std::string page = report_of(directory, "verify gantry --duration 0.5");
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"?https?:")));
  for (const int width : {400, 1600}) {
    const std::string document = document_of(directory, page, width);
    EXPECT_EQ(attribute(document, "data-ready"), "ok") << width << " px";
    EXPECT_NE(document.find("<canvas"), std::string::npos) << "charts are drawn, " << width << " px";
    EXPECT_NE(document.find("Over the run"), std::string::npos) << width << " px";
    EXPECT_NE(document.find(">Verified<"), std::string::npos) << width << " px";
  }
}

TEST(ReportOfAVerification, ShowsWhatFails) {
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const Directory directory;
  const std::string page = report_of(directory, "verify gantry --duration 0.1 --digits 16");
  const std::string document = document_of(directory, page, 800);
  EXPECT_EQ(attribute(document, "data-ready"), "ok");
  EXPECT_EQ(document.find(">Verified<"), std::string::npos);
  EXPECT_NE(document.find("class=\"fails"), std::string::npos);
}

TEST(ReportCheck, SeesAScriptThatFails) {
  if (!browser_is_here()) GTEST_SKIP() << "chromium is not installed";
  const Directory directory;
  std::string page = report_of(directory, "run crank_rocker --duration 0.1");
  const std::size_t end = page.rfind("</body>");
  ASSERT_NE(end, std::string::npos);
  page.insert(end, "<script>nothing.of.the.kind();</script>");
  EXPECT_EQ(attribute(document_of(directory, page, 800), "data-ready"), "failed");
}

}  // namespace
