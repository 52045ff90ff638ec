// What can be printed has a name, and what is computed for the compiler is the same when a program computes it.
#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <slideway/step.hpp>
#include <string>

namespace {

using namespace slideway;

/// The texts of an enumeration's numbers until `unknown` is said of one.
template <class Enum, class Text>
std::set<std::string> texts(Text&& text, const std::string& unknown) {
  std::set<std::string> found;
  for (int k = 0; k < 256; ++k) {
    const std::string t = text(static_cast<Enum>(k));
    if (t == unknown) {
      EXPECT_EQ(found.size(), static_cast<std::size_t>(k)) << "two of them have one text";
      return found;
    }
    EXPECT_FALSE(t.empty());
    found.insert(t);
  }
  ADD_FAILURE() << "a text for every number";
  return found;
}

constexpr auto its_name = [](auto value) { return name(value); };
constexpr auto its_sentence = [](auto value) { return sentence(value); };

TEST(Names, OfEveryKindAreDifferent) {
  EXPECT_EQ(texts<Status>(its_name, "unknown").size(), static_cast<std::size_t>(Status::event_limit) + 1);
  EXPECT_EQ(texts<Uniqueness>(its_name, "unknown").size(), static_cast<std::size_t>(Uniqueness::refuted) + 1);
  EXPECT_EQ(texts<EventKind>(its_name, "unknown").size(), static_cast<std::size_t>(EventKind::normal_reversal) + 1);
  EXPECT_EQ(texts<Method>(its_name, "unknown").size(), std::size(methods));
}

TEST(Names, SentencesSayWhatIsWrong) {
  EXPECT_EQ(texts<Status>(its_sentence, "Unknown status.").size(), static_cast<std::size_t>(Status::event_limit) + 1);
  for (const std::string& text : texts<Status>(its_sentence, "Unknown status.")) EXPECT_EQ(text.back(), '.') << text;
  EXPECT_EQ(texts<Defect>(its_sentence, "is defective").size(), static_cast<std::size_t>(Defect::negative_gain) + 1);
}

TEST(Names, MethodsAreListedInTheOrderOfTheirNumbers) {
  for (int k = 0; k < static_cast<int>(std::size(methods)); ++k) EXPECT_EQ(static_cast<int>(methods[k]), k);
}

template <int Stages>
void expect_completed(const Tableau<Stages>& known) {
  Tableau<Stages> bare = known;
  for (int k = 0; k < Stages; ++k) {
    bare.c[k] = bare.ba[k] = 0;
    for (int j = 0; j < Stages; ++j) bare.aa[k][j] = 0;
  }
  const Tableau<Stages> now = detail::completed(bare);
  EXPECT_EQ(std::memcmp(&now, &known, sizeof now), 0);
  // y' = 1 and q'' = 1 are solved exactly.
  double b = 0, ba = 0, doubt[2] = {};
  for (int k = 0; k < Stages; ++k) {
    b += known.b[k];
    ba += known.ba[k];
    for (int d = 0; d < 2; ++d) doubt[d] += known.doubt[d][k];
  }
  EXPECT_NEAR(b, 1, 1e-14);
  EXPECT_NEAR(ba, 0.5, 1e-14);
  for (const double d : doubt) EXPECT_NEAR(d, 0, 1e-14);
}

TEST(Tableau, IsTheSameFromTheCompilerAndFromTheProgram) {
  expect_completed(runge_kutta_4);
  expect_completed(dormand_prince_8);
}

TEST(Size, ArraysHaveRoomForOneAtLeast) {
  for (int n = -1; n < 3; ++n) EXPECT_EQ(at_least_one(n), n == 2 ? 2 : 1);
}

}  // namespace
