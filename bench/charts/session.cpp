#include "session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace slideway::charts {
namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

Progress Session::progress(const std::string& name) const {
  if (isatty(STDERR_FILENO) != 1) return [](double, const std::string&) {};
  return [name](double part, const std::string& what) {
    if (part >= 1) return fmt::print(stderr, "\r\33[K");
    fmt::print(stderr, "\r\33[K{}: {:3.0f} % {}", name, 100 * part, what);
  };
}

void Session::draw(const std::string& name, const Chart& chart) const {
  write_text(charts / (name + ".svg"), svg(chart, line(made)));
}

void Session::draw(const std::string& name, const Map& map) const {
  write_text(charts / (name + ".svg"), svg(map, line(made)));
}

void Session::write(const std::string& name, io::Json document) const {
  document["made"] = charts::document(made);
  write_text(results / (name + ".json"), io::text(document));
}

}  // namespace slideway::charts
