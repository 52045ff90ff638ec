// Files of the source tree as text.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace slideway::test {

/// A file's text; the path is relative to the source tree.
inline std::string text_of(const std::string& file) {
  std::ifstream in(std::string(SLIDEWAY_SOURCE_DIR "/") + file);
  EXPECT_TRUE(in) << file;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace slideway::test
