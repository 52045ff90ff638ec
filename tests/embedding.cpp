// docs/embedding.md's example is the program that tests/embedded compiles and runs, and its ladder has every status.
#include <gtest/gtest.h>

#include <slideway/self_test.hpp>
#include <string>
#include <support/text.hpp>

namespace {

using slideway::test::text_of;

TEST(Embedding, ExampleIsTheProgramThatIsCompiled) {
  const std::string page = text_of("docs/embedding.md"), program = text_of("tests/embedded/recovery.cpp");
  EXPECT_NE(page.find("```cpp\n" + program + "```\n"), std::string::npos);
}

TEST(Embedding, EveryStatusHasARow) {
  const std::string page = text_of("docs/embedding.md");
  for (int k = 0; k <= static_cast<int>(slideway::Status::event_limit); ++k) {
    const std::string status = name(static_cast<slideway::Status>(k));
    EXPECT_NE(page.find("\n| `" + status + "` |"), std::string::npos) << status;
  }
}

TEST(Embedding, EveryMethodHasARow) {
  const std::string page = text_of("docs/embedding.md");
  for (const slideway::Method method : slideway::methods) {
    EXPECT_NE(page.find(std::string("\n| `") + name(method) + "` |"), std::string::npos) << name(method);
  }
}

TEST(Embedding, EveryResultOfTheSelfTestIsNamed) {
  const std::string page = text_of("docs/embedding.md");
  for (int k = 0; k <= static_cast<int>(slideway::SelfTest::stepping); ++k) {
    const std::string result = name(static_cast<slideway::SelfTest>(k));
    EXPECT_NE(page.find("`" + result + "`"), std::string::npos) << result;
  }
}

}  // namespace
