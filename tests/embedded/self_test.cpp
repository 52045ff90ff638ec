// The power-on self-test, and what a damaged program would go on to do: a hundred steps of the self-test's own
// mechanism by each method. tests/self_test.cpp flips bits of this program.
//
//     self_test              the verdict, then the hashes of a hundred steps; exit 1 unless passed
//     self_test --golden     what slideway/self_test.hpp must know, when the kernel's arithmetic has changed on
//     purpose:
// g++ -std=c++17 -O2 -ffp-contract=off -I kernel tests/embedded/self_test.cpp -o self_test && ./self_test --golden
#include <cstdio>
#include <cstring>
#include <slideway/self_test.hpp>

using slideway::self_test_detail::golden;
using slideway::self_test_detail::hash_of_steps;

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--golden") == 0) {
    for (const auto& known : golden) {
      const auto hash = hash_of_steps(known.method, slideway::self_test_detail::golden_steps);
      std::printf("    {Method::%s, 0x%016llx},\n", name(known.method), static_cast<unsigned long long>(hash));
    }
    return 0;
  }
  const slideway::SelfTest result = slideway::self_test();
  std::printf("%s\n", name(result));
  std::fflush(stdout);
  const volatile int hundred = 100;  // unknown to the compiler, which would make a copy of the stepper for this number
  for (const auto& known : golden) {
    std::printf("%016llx\n", static_cast<unsigned long long>(hash_of_steps(known.method, hundred)));
  }
  return result == slideway::SelfTest::passed ? 0 : 1;
}
