// HTML pages that need nothing but themselves: templates of report/ with scripts, styles and data filled in.
#pragma once

#include <iosfwd>
#include <slideway/io/json.hpp>
#include <string_view>

namespace slideway::app {

/// x to this many significant digits, for a page's data; null if x is not finite.
io::Json rounded(double x, int digits);

/// Writes the file `page` of report/: {{title}} becomes the title, {{data}} the data, and {{FILE}} the text of another
/// file of report/ or of dygraphs. Failure shows in the state of `out`, as for every stream.
void write_page(std::string_view page, std::string_view title, const io::Json& data, std::ostream& out);

}  // namespace slideway::app
