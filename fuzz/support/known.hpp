// What has been found and is not mended yet, so that targets find something else. Each goes when its cause goes.
#pragma once

#include <slideway/properties/hlcp.hpp>

namespace slideway::fuzz::known {

/// Where products of data beyond 2^+-200 and x underflow or overflow, rows of an answer are missed by all of their
/// terms, one of two solutions may be none, and whether one is chosen depends on the start.
bool is_extreme(const properties::HlcpCase& problem);

/// Above order 4 two certified answers, from other signs, differ in what is a tie of zero and rounding.
bool are_tied(const properties::HlcpAnswer& a, const properties::HlcpAnswer& b, int n);

/// Above order 4, rounding hides that a singular problem has no solution, or one: then answers without proof are wrong.
bool is_hidden(const properties::HlcpCheck& check, int n);

}  // namespace slideway::fuzz::known
