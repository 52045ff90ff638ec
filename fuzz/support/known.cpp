#include "support/known.hpp"

#include <cmath>

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

}  // namespace slideway::fuzz::known
