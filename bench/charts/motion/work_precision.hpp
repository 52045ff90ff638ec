// Speed against accuracy for one scene: charts, numbers, and by how much the cheapest method is cheaper.
#pragma once

#include <slideway/io/json.hpp>
#include <slideway/io/scene_file.hpp>

#include "figure.hpp"
#include "measure.hpp"

namespace slideway::charts {

struct WorkPrecision {
  io::SceneFile scene;
  oracle::Reference reference;
  Contenders contenders;
  std::vector<Measured> measured;
};

/// Measures the methods in `contenders` and SUNDIALS. The scene must outlive nothing: it is kept in the result.
/// Errors are of positions (max over 16 times, over the largest coordinate).
Chart time_chart(const WorkPrecision& wp);
Chart evaluations_chart(const WorkPrecision& wp);
Chart force_chart(const WorkPrecision& wp);

/// All that was measured, and how many times cheaper the cheapest method is than each family, by decade of the error.
io::Json document(const WorkPrecision& wp);

/// Is it one of the kernel's methods?
bool is_kernel(const Contender& contender);

/// Decades of the error that peers are compared at: 1e-3 to 1e-11.
inline constexpr int first_decade = 3, last_decade = 11;

}  // namespace slideway::charts
