// A recording as one HTML page that needs nothing but itself.
#pragma once

#include <iosfwd>

#include "recording.hpp"

namespace slideway::app {

/// The page: drawing, charts and tables of `recording`, with scripts, styles and data inside it. It asks no network for
/// anything. Failure shows in the state of `out`, as for every stream.
void write_report(const Recording& recording, std::ostream& out);

}  // namespace slideway::app
