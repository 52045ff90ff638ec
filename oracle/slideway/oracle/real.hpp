// The oracle's number: 50 decimal digits, in which every double is exact.
#pragma once

#include <boost/multiprecision/mpfr.hpp>

namespace slideway::oracle {

using Real =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<50, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

/// Relative size below which a difference of computed numbers counts as zero: between the rounding of long computations
/// (1e-50, grown by a thousand operations and condition numbers up to 1e12: 1e-35) and what data in doubles can differ
/// by when they differ (1e-16 and its products). Unit roundoff to the power 0.6: 1e-30 for Real.
template <class T>
T zero_tolerance() {
  using std::pow;
  static const T tolerance = pow(std::numeric_limits<T>::epsilon(), T(0.6));
  return tolerance;
}

/// The larger of two errors; NaN if either is: an error that is not a number is the worst.
template <class T>
T worse(const T& a, const T& b) {
  return a != a || a >= b ? a : b;
}

}  // namespace slideway::oracle
