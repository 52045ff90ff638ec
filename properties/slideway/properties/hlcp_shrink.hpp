// Making a problem small.
#pragma once

#include <cmath>
#include <slideway/properties/hlcp.hpp>

namespace slideway::properties {

/// The problem without row and column k.
inline HlcpCase without(const HlcpCase& problem, int k) {
  HlcpCase smaller{problem.n - 1, {}};
  for (int i = 0, r = 0; i < problem.n; ++i) {
    if (i == k) continue;
    for (int j = 0, c = 0; j < problem.n; ++j) {
      if (j == k) continue;
      smaller.data.plus[r][c] = problem.data.plus[i][j];
      smaller.data.minus[r][c] = problem.data.minus[i][j];
      ++c;
    }
    smaller.data.b[r] = problem.data.b[i];
    ++r;
  }
  return smaller;
}

/// x rounded to `bits` binary digits.
inline double rounded(double x, int bits) {
  int exponent = 0;
  const double part = std::frexp(x, &exponent);
  return std::ldexp(std::round(std::ldexp(part, bits)), exponent - bits);
}

/// The smallest problem found for which `same` still holds: rows and columns dropped, entries set to 0, +-1, powers of
/// two and integers, bits dropped, as long as that goes. same(problem) must hold. At most some thousand calls of it.
template <class Same>
HlcpCase shrink(HlcpCase problem, const Same& same) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    for (int k = problem.n - 1; k >= 0 && problem.n > 1; --k) {
      const HlcpCase tried = without(problem, k);
      if (!same(tried)) continue;
      problem = tried;
      smaller = true;
    }
    const auto simplify = [&](double& entry) {
      const double kept = entry;
      if (kept == 0 || kept == 1 || !std::isfinite(kept)) return;
      const double candidates[] = {0,
                                   1,
                                   -1,
                                   std::copysign(std::exp2(std::round(std::log2(std::fabs(kept)))), kept),
                                   std::round(kept),
                                   rounded(kept, 3),
                                   rounded(kept, 8),
                                   rounded(kept, 24)};
      for (const double candidate : candidates) {
        if (candidate == kept) break;  // those that follow are no simpler
        entry = candidate;
        if (same(problem)) {
          smaller = true;
          return;
        }
      }
      entry = kept;
    };
    for (int i = 0; i < problem.n; ++i) {
      for (int j = 0; j < problem.n; ++j) {
        simplify(problem.data.plus[i][j]);
        simplify(problem.data.minus[i][j]);
      }
      simplify(problem.data.b[i]);
    }
  }
  return problem;
}

}  // namespace slideway::properties
