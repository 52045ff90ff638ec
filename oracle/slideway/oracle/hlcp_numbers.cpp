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
  Rational worst = 0;
  const int columns = 2 * problem.n + 1;
  for (int i = 0; i < problem.n; ++i) {
    const Integer* row = problem.rows.data() + i * columns;
    const Rational b = cpp_int(row[2 * problem.n]);
    Rational miss = -b;
    Rational size = abs(b);
    for (int j = 0; j < problem.n; ++j) {
      const Rational& value = x.at(static_cast<std::size_t>(j));
      if (value.is_zero()) continue;
      const Rational term = Rational(cpp_int(row[value < 0 ? problem.n + j : j])) * value;
      miss += term;
      size += abs(term);
    }
    if (!size.is_zero()) worst = std::max<Rational>(worst, abs(miss) / size);
  }
  return worst;
}

Rational distance(const Exact& x, const Exact& y) {
  Rational most = 0, size = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    most = std::max<Rational>(most, abs(x[k] - y.at(k)));
    size = std::max<Rational>(size, abs(y[k]));
  }
  return size.is_zero() ? most : most / size;
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
  // |value| = (q + rest / bottom) 2^-shift, q of 63 or 64 bits; that there is a rest is kept in the last of them.
  cpp_int top = abs(numerator(value)), bottom = denominator(value), q, rest;
  const int shift = 63 - (static_cast<int>(msb(top)) - static_cast<int>(msb(bottom)));
  (shift > 0 ? top : bottom) <<= std::abs(shift);
  divide_qr(top, bottom, q, rest);
  const std::uint64_t bits = static_cast<std::uint64_t>(q) | (rest.is_zero() ? 0u : 1u);
  const double size = std::ldexp(static_cast<double>(bits), -shift);  // the conversion rounds, ties to even
  return value < 0 ? -size : size;
}

}  // namespace slideway::oracle
