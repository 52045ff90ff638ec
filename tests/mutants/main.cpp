// The tests with one mutant switched on: SLIDEWAY_MUTANT=NUMBER. SLIDEWAY_REACHED=FILE: the numbers of the mutants that
// were passed, one a line, once all is over.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace {
constexpr int room = 10000;  // more than `generate` finds

slideway_mutant::Number chosen() {
  const char* number = std::getenv("SLIDEWAY_MUTANT");
  return {number == nullptr ? 0 : std::atoi(number)};
}
}  // namespace

// Before any test's globals.
__attribute__((init_priority(101))) const slideway_mutant::Number slideway_mutant::active = chosen();
bool slideway_mutant::reached[room];

int main(int count, char** arguments) {
  testing::InitGoogleTest(&count, arguments);
  const int result = RUN_ALL_TESTS();
  if (const char* file = std::getenv("SLIDEWAY_REACHED")) {
    std::ofstream out(file);
    for (int number = 0; number < room; ++number) {
      if (slideway_mutant::reached[number]) out << number << '\n';
    }
  }
  return result;
}
