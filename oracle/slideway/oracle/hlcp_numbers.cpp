// Numbers in and out of the exact HLCP, and what a candidate misses.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "hlcp.hpp"

namespace slideway::oracle {
namespace {

namespace mp = boost::multiprecision;
using mp::cpp_int;

/// value = mantissa 2^exponent, the mantissa odd or 0 and below 2^53.
struct Parts {
  std::int64_t mantissa;
  int exponent;
};

Parts parts(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a number is not finite");
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  if (mantissa == 0) return {0, 0};
  for (exponent -= 53; mantissa % 2 == 0; mantissa /= 2) ++exponent;
  return {mantissa, exponent};
}

/// x = top / bottom, bottom > 0: sums of these need no fractions in lowest terms.
struct Common {
  std::vector<Integer> top;
  Integer bottom = 1;
};

Common over_common(const Exact& x) {
  Common common;
  for (const Rational& value : x) {
    const Integer bottom(denominator(value));
    if (!(common.bottom % bottom).is_zero()) common.bottom *= bottom / gcd(common.bottom, bottom);
  }
  for (const Rational& value : x)
    common.top.push_back(Integer(numerator(value)) * (common.bottom / Integer(denominator(value))));
  return common;
}

Common over_common(const double* x, int n) {
  int least = 0;
  for (int k = 0; k < n; ++k) least = std::min(least, parts(x[k]).exponent);
  Common common;
  common.top.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    const Parts part = parts(x[k]);
    common.top.emplace_back(part.mantissa) <<= part.exponent - least;
  }
  common.bottom <<= -least;
  return common;
}

struct Quotient {
  Integer top, bottom;
};

Quotient worst_of(const ExactHlcp& problem, const Common& x) {
  Quotient worst{0, 1};
  const int columns = 2 * problem.n + 1;
  for (int i = 0; i < problem.n; ++i) {
    const Integer* row = problem.rows.data() + i * columns;
    const Integer b = row[2 * problem.n] * x.bottom;
    Integer miss = -b;
    Integer size = abs(b);
    for (int j = 0; j < problem.n; ++j) {
      const Integer& value = x.top.at(static_cast<std::size_t>(j));
      if (value.is_zero()) continue;
      const Integer term = row[value < 0 ? problem.n + j : j] * value;
      miss += term;
      size += abs(term);
    }
    miss = abs(miss);
    if (miss * worst.bottom > worst.top * size) worst = {miss, size};
  }
  return worst;
}

/// top / bottom, both > 0. It is (q + rest / bottom) 2^-shift, q of 63 or 64 bits; that there is a rest is kept in the
/// last of them.
double nearest(Integer top, Integer bottom) {
  Integer q, rest;
  const int shift = 63 - (static_cast<int>(msb(top)) - static_cast<int>(msb(bottom)));
  (shift > 0 ? top : bottom) <<= std::abs(shift);
  divide_qr(top, bottom, q, rest);
  const std::uint64_t bits = static_cast<std::uint64_t>(q) | (rest.is_zero() ? 0u : 1u);
  return std::ldexp(static_cast<double>(bits), -shift);  // the conversion rounds, ties to even
}

}  // namespace

void append_row(ExactHlcp& problem, const std::vector<double>& row) {
  int least = std::numeric_limits<int>::max();
  for (const double value : row)
    if (value != 0.0) least = std::min(least, parts(value).exponent);
  for (const double value : row) {
    const Parts part = parts(value);
    Integer& scaled = problem.rows.emplace_back(part.mantissa);
    if (part.mantissa != 0) scaled <<= part.exponent - least;
  }
}

void append_row(ExactHlcp& problem, const Exact& row) {
  cpp_int common = 1;
  for (const Rational& value : row) common = lcm(common, denominator(value));
  for (const Rational& value : row) problem.rows.emplace_back(numerator(value) * (common / denominator(value)));
}

Rational residual(const ExactHlcp& problem, const Exact& x) {
  const Quotient worst = worst_of(problem, over_common(x));
  return Rational(cpp_int(worst.top), cpp_int(worst.bottom));
}

double residual(const ExactHlcp& problem, const double* x) {
  const Quotient worst = worst_of(problem, over_common(x, problem.n));
  return worst.top.is_zero() ? 0.0 : nearest(worst.top, worst.bottom);
}

Rational distance(const Exact& x, const Exact& y) {
  const Common a = over_common(x), c = over_common(y);
  Integer most = 0, size = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    most = std::max<Integer>(most, abs(a.top[k] * c.bottom - c.top.at(k) * a.bottom));
    size = std::max<Integer>(size, abs(c.top[k]));
  }
  if (most.is_zero()) return 0;
  return Rational(cpp_int(most), cpp_int(a.bottom * (size.is_zero() ? c.bottom : size)));
}

Exact exact_vector(const double* x, int n) {
  Exact vector;
  for (int k = 0; k < n; ++k) {
    const Parts part = parts(x[k]);
    const cpp_int power = cpp_int(1) << std::abs(part.exponent);
    vector.push_back(part.exponent < 0 ? Rational(cpp_int(part.mantissa), power)
                                       : Rational(cpp_int(part.mantissa) * power));
  }
  return vector;
}

double nearest_double(const Rational& value) {
  if (value.is_zero()) return 0.0;
  const double size = nearest(Integer(abs(numerator(value))), Integer(denominator(value)));
  return value < 0 ? -size : size;
}

}  // namespace slideway::oracle
