// What a step costs as a mechanism grows: 1 to 64 sliders on one crank, driven or not, and in a chain.
#pragma once

#include <functional>
#include <slideway/io/json.hpp>

#include "figure.hpp"

namespace slideway::charts {

struct Growth {
  std::string family;  ///< "driven crank", ...
  int sliders;
  double ns;          ///< of an rk4 step, warm: median
  double low, high;   ///< least and most of the repetitions
  int parts, rows;    ///< HLCPs and rough contacts of the largest
  std::size_t bytes;  ///< of scene, tables and state, in room for exactly this many sliders
};

std::vector<Growth> measure_growth(int repetitions, const std::function<void(double, const std::string&)>& progress);
Chart growth_chart(const std::vector<Growth>& growth);
/// d log(ns) / d log(sliders) between two sizes of a family.
double exponent(const std::vector<Growth>& growth, const std::string& family, int from, int to);
io::Json document(const std::vector<Growth>& growth);

}  // namespace slideway::charts
