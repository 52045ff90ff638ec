#include "support/fail.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace slideway::fuzz {

void fail(const std::string& what) {
  std::string line = what;
  std::replace(line.begin(), line.end(), '\n', ' ');
  fmt::print(stderr, "FUZZ {0} FAILED: {1}; rerun: build/fuzz/{0} FILE\n", target, line);
  std::abort();
}

}  // namespace slideway::fuzz
