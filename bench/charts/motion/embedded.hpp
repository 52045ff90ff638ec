// The shipped scenes that are charted, known to the compiler.
#pragma once

#include <string>
#include <vector>

#include "contender.hpp"

namespace slideway::charts {

struct EmbeddedScene {
  std::string name;
  void (*add)(double interval, Contenders& contenders);
};

const std::vector<EmbeddedScene>& embedded_scenes();

}  // namespace slideway::charts
