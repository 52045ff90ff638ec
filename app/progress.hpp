// How far long work is, on a terminal only, a few times a second.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace slideway::app {

class Progress {
 public:
  explicit Progress(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) == 1) {}
  /// `done` of 1; `what` is being done.
  void show(double done, const char* what) {
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    fmt::print(stderr, "\r{:5.1f} % {:<40} ", 100.0 * done, what);
    std::fflush(stderr);
    dirty_ = true;
  }
  ~Progress() {
    if (dirty_) fmt::print(stderr, "\r{:60}\r", "");
  }

 private:
  bool shown_, dirty_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace slideway::app
