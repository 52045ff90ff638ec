// Who is measured: something that carries a scene from its start through given times, at a setting that makes it more
// or less accurate.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "equations.hpp"

namespace slideway::charts {

/// What a run came to at the times asked for.
struct Outcome {
  std::string failure;                         ///< empty: it went through
  std::vector<std::vector<double>> q, lambda;  ///< by time; the joints' coordinates, the contact forces
  long evaluations = 0;                        ///< of accelerations
};

class Contender {
 public:
  virtual ~Contender() = default;
  /// From the start through `times`, ascending.
  virtual Outcome run(const std::vector<double>& times, double setting) const = 0;

  std::string family;            ///< contenders of one family are charted as one: the best of them
  std::string name;              ///< within the family, with what was chosen
  std::string setting;           ///< what the setting is: "dt", "tolerance"
  std::vector<double> settings;  ///< from coarse to fine
};

using Contenders = std::vector<std::unique_ptr<Contender>>;

/// SUNDIALS: Adams, BDF and explicit Runge-Kutta methods on regularised friction of several widths, and on modes with
/// root finding; IDA on both. Nothing where it was not found when this was built: see has_sundials.
void add_sundials(const RunScene& scene, Contenders& contenders);
extern const bool has_sundials;

}  // namespace slideway::charts
