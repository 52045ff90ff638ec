// A run of the kernel, kept as states, for `slideway verify`; the same run with finer steps tells how far it has
// converged.
#pragma once

#include <vector>

#include "preparation.hpp"
#include "progress.hpp"

namespace slideway::app {

struct KernelRun {
  std::vector<RunState> states;  ///< first, every so many steps, last
  std::vector<Sample> samples;   ///< of the same instants
  std::vector<std::vector<double>> accelerations;
  std::vector<Uniqueness> uniqueness;
  Recording recording;  ///< of the whole run
};

/// At most this many samples, equally many steps apart.
inline constexpr long long most_verified_samples = 400;

/// Makes the planned steps, each in `divisor` parts. Ends at the first refusal, which the recording tells.
KernelRun run_kernel(const Preparation& prepared, int divisor, Progress& progress);

}  // namespace slideway::app
