// Errors: one line each on standard error.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

namespace slideway::app {

inline void complain(const std::string& message) {
  std::string line = message;
  std::replace(line.begin(), line.end(), '\n', ' ');
  fmt::print(stderr, "{}\n", line);
}

template <class First, class... Rest>
void complain(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
  complain(fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...));
}

}  // namespace slideway::app
