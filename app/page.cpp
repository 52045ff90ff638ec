#include "page.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <slideway/embedded/page.hpp>
#include <string>

namespace slideway::app {
namespace {

/// The data as JSON. "<" is written as an escape, so that no text in it can end the script element that holds it.
std::string script_text(const io::Json& data) {
  std::string text;
  for (char c : data.dump(-1, ' ', true, io::Json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string_view embedded_file(std::string_view name) {
  for (const auto& [file, text] : embedded::page) {
    if (file != name) continue;
    // A last line that names a source map would be the page's only request.
    const auto map = text.rfind("# sourceMappingURL=");
    return map == text.npos ? text : text.substr(0, text.rfind('\n', map));
  }
  return {};
}

}  // namespace

io::Json rounded(double x, int digits) {
  if (!std::isfinite(x)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return std::strtod(text, nullptr);
}

void write_page(std::string_view page, std::string_view title, const io::Json& data, std::ostream& out) {
  std::string_view rest = embedded_file(page);
  for (auto open = rest.find("{{"); open != rest.npos; open = rest.find("{{")) {
    const auto close = rest.find("}}", open);
    const std::string_view key = rest.substr(open + 2, close - open - 2);
    out << rest.substr(0, open);
    if (key == "title") {
      out << escaped(title);
    } else if (key == "data") {
      out << script_text(data);
    } else {
      out << embedded_file(key);
    }
    rest.remove_prefix(close + 2);
  }
  out << rest;
}

}  // namespace slideway::app
