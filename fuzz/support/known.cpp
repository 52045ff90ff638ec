#include "support/known.hpp"

#include <cstdio>

namespace slideway::fuzz::known {

bool gives_energy(const io::RunStepper& stepper, const Report& report, double dt, const std::string& violation) {
  if (!violation.starts_with("friction and dampers gave")) return false;
  const auto& source = stepper.source;
  const double rounding = 0x1p-40 * properties::typical_force(source.scene) * source.tables.length;
  const bool off = report.drift_position > 1e-9 || report.drift_velocity > 1e-9;
  return report.events + report.unlocated_events > 0 || dt > 0.05 || off || report.energy.dissipated > -rounding;
}

bool overflows(double dt) { return dt > 1e9; }

bool is_at_limit(const std::string& violation) {
  int guide = 0;
  double force = 0, limit = 0;
  const int read = std::sscanf(violation.c_str(), "guide %d: |F| = %lf N is beyond mu_static Lambda + preload = %lf N",
                               &guide, &force, &limit);
  return read == 3 && force <= limit * (1 + 1e-10);
}

}  // namespace slideway::fuzz::known
