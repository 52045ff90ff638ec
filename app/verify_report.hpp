// A verification as one HTML page that needs nothing but itself.
#pragma once

#include <iosfwd>

#include "verification.hpp"

namespace slideway::app {

/// The page: verdict, tables of all checks, errors over the run, and what was not checked. It asks no network for
/// anything. Failure shows in the state of `out`, as for every stream.
void write_verify_report(const Verification& verification, std::ostream& out);

}  // namespace slideway::app
