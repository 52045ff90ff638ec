// What holds of the kernel's answers to one HLCP, whatever it is asked with.
#pragma once

#include <slideway/properties/hlcp.hpp>

namespace slideway::fuzz {

/// How near to what rounding cannot tell from something else.
enum class Numbers {
  any,      ///< any doubles: an answer may be refused as inaccurate or singular
  readable  ///< a few bits: up to order 4 everything is decided
};

/// The largest order that is held against all exact solutions; above it, residuals and bits alone are.
inline constexpr int most_exact_order = 5;

/// Fails unless the answer from the signs in `start` is true, is the same from other signs or in other room (by a bit
/// of `start`), and a refusal leaves x and sign as they were.
void hold_hlcp(const properties::HlcpCase& problem, unsigned long long start, HlcpOptions options, Numbers numbers);

}  // namespace slideway::fuzz
