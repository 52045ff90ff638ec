// README's example is the program that tests/embedded compiles and runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(std::string(SLIDEWAY_SOURCE_DIR "/") + file);
  EXPECT_TRUE(in) << file;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Readme, ExampleIsTheProgramThatIsCompiled) {
  const std::string readme = text_of("README.md"), program = text_of("tests/embedded/readme.cpp");
  EXPECT_NE(readme.find("```cpp\n" + program + "```\n"), std::string::npos);
}

TEST(Readme, IsUnderTwoScreens) {
  const std::string readme = text_of("README.md");
  EXPECT_LT(std::count(readme.begin(), readme.end(), '\n'), 100);
}

}  // namespace
