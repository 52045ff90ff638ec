// The kernel's answer to a problem held against all exact solutions.
#pragma once

#include <optional>
#include <slideway/hlcp_problem.hpp>
#include <slideway/oracle/hlcp.hpp>
#include <string>

#include "hlcp_problem.hpp"

namespace slideway::app {

using HlcpKernel = HlcpSolution<hlcp_max_order>;

struct HlcpCheck {
  HlcpKernel kernel = {};
  std::optional<oracle::ExactAnswer> exact;  ///< none above oracle::exact_max_order
  bool agree = false;
  std::string verdict;

  // Where the kernel has an x:
  double residual = 0.0;  ///< of x, exactly (rounded once); in the kernel's measure
  int nearest = -1;       ///< isolated solution nearest to x, if there is one
  double distance = 0.0;  ///< from it, relative, in the largest component

  bool solved() const noexcept { return kernel.status == Status::ok; }
};

/// Holds the kernel's answer to the problem, or what is said to be one, against the exact ones.
HlcpCheck check_hlcp(const HlcpProblem& problem, const HlcpKernel& kernel);

/// "no solution", "one solution", "3 solutions", "a continuum of solutions".
std::string describe(const oracle::ExactAnswer& answer);

}  // namespace slideway::app
