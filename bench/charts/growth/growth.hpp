// What a step costs as a mechanism grows: 1 to 64 sliders on one crank, driven or not, and in a chain.
#pragma once

#include <functional>
#include <slideway/io/json.hpp>

#include "figure.hpp"

namespace slideway::charts {

/// What a mechanism takes in room for exactly its sliders, bytes.
struct Bytes {
  std::size_t scene = 0, tables = 0, state = 0, stack = 0;  ///< stack: of a step, as deep as it went
  std::size_t all() const { return scene + tables + state + stack; }
};

/// A mechanism of one size, ready to run.
struct GrowthCase {
  std::string family;  ///< "driven crank", ...
  int sliders;
  int parts, rows;  ///< HLCPs, and rough contacts of the largest
  Bytes bytes;
  std::function<int()> run;  ///< growth_steps steps from the start; HLCP solves at most, 0 where a step was refused
};

inline constexpr int growth_steps = 100;
inline constexpr double growth_dt = 5e-5;  ///< s

/// Cases of one size; each size is a file of its own, made by CMake: see growth_size.cpp.in.
using AddGrowth = void (*)(std::vector<GrowthCase>& cases);
const std::vector<AddGrowth>& growth_sizes();

struct Growth {
  std::string family;
  int sliders, parts, rows, solves;
  Bytes bytes;
  double ns, low, high;  ///< of an rk4 step, signs of the last step tried first: median, least and most
};

std::vector<Growth> measure_growth(int repetitions, const std::function<void(double, const std::string&)>& progress);
Chart growth_chart(const std::vector<Growth>& growth);
Chart memory_chart(const std::vector<Growth>& growth);
/// d log(ns) / d log(sliders) between two sizes of a family; NaN where one is missing.
double exponent(const std::vector<Growth>& growth, const std::string& family, int from, int to);
io::Json document(const std::vector<Growth>& growth);

}  // namespace slideway::charts
