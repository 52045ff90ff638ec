#include "support/known.hpp"

#include <cmath>
#include <cstdio>

namespace slideway::fuzz::known {

bool is_extreme(const properties::HlcpCase& problem) {
  const auto extreme = [](double x) { return x != 0 && !(std::fabs(x) > 0x1p-200 && std::fabs(x) < 0x1p200); };
  bool any = false;
  for (int i = 0; i < problem.n; ++i) {
    for (int j = 0; j < problem.n; ++j)
      any = any || extreme(problem.data.plus[i][j]) || extreme(problem.data.minus[i][j]);
    any = any || extreme(problem.data.b[i]);
  }
  return any;
}

bool are_tied(const properties::HlcpAnswer& a, const properties::HlcpAnswer& b, int n) {
  double largest = 0, apart = 0;
  for (int k = 0; k < n; ++k) {
    largest = std::fmax(largest, std::fabs(a.x[k]));
    apart = std::fmax(apart, std::fabs(a.x[k] - b.x[k]));
  }
  return n > 4 && apart <= 0x1p-20 * largest;
}

bool is_hidden(const properties::HlcpCheck& check, int n) {
  return n > 4 && check.exact && !check.exact->w_property && check.answer.uniqueness != Uniqueness::certified;
}

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
