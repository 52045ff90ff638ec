// What the stack holds before a call must not matter to it.
#pragma once

#include <limits>

namespace slideway::test {

/// Leaves what is no number where the arrays of the next call will be: 2 MiB, some times what a step with the command's
/// room takes.
[[gnu::noinline]] inline void litter_stack() noexcept {
  volatile double litter[262144];
  for (volatile double& x : litter) x = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace slideway::test
