// What one run of slideway-charts was asked for, and where its figures go.
#pragma once

#include <filesystem>
#include <functional>
#include <slideway/io/json.hpp>
#include <string>

#include "figure.hpp"
#include "provenance.hpp"

namespace slideway::charts {

using Progress = std::function<void(double part, const std::string& what)>;

struct Session {
  bool quick = false;  ///< coarse settings alone, to see that everything still draws: nothing for docs
  std::filesystem::path charts, results;  ///< directories that exist
  Provenance made;

  /// Shown on a terminal only.
  Progress progress(const std::string& name) const;
  /// NAME.svg and NAME.json, with how they were made. runtime_error, in one line, if one cannot be written.
  void draw(const std::string& name, const Chart& chart) const;
  void draw(const std::string& name, const Map& map) const;
  void write(const std::string& name, io::Json document) const;
};

}  // namespace slideway::charts
