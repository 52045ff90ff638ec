// README's example is the program that tests/embedded compiles and runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <support/text.hpp>

namespace {

using slideway::test::text_of;

TEST(Readme, ExampleIsTheProgramThatIsCompiled) {
  const std::string readme = text_of("README.md"), program = text_of("tests/embedded/readme.cpp");
  EXPECT_NE(readme.find("```cpp\n" + program + "```\n"), std::string::npos);
}

TEST(Readme, IsUnderTwoScreens) {
  const std::string readme = text_of("README.md");
  EXPECT_LT(std::count(readme.begin(), readme.end(), '\n'), 100);
}

}  // namespace
