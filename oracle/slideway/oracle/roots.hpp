// The first root of a polynomial in an interval: how the oracle locates events.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <slideway/oracle/real.hpp>
#include <vector>

namespace slideway::oracle {

namespace detail {

template <class T>
T value_at(const std::vector<T>& power, const T& x) {
  T sum(0);
  for (std::size_t k = power.size(); k-- > 0;) sum = sum * x + power[k];
  return sum;
}

/// Coefficients in Bernstein's basis on [0, 1]: b_i = sum over k <= i of C(i, k) / C(n, k) a_k.
template <class T>
std::vector<T> bernstein(std::vector<T> a) {
  const std::size_t n = a.size() - 1;
  T binomial(1);
  for (std::size_t k = 0; k <= n; ++k) {
    a[k] /= binomial;
    binomial = binomial * T(static_cast<int>(n - k)) / T(static_cast<int>(k + 1));
  }
  for (std::size_t pass = 1; pass <= n; ++pass) {  // sums with binomial weights, by repeated additions
    for (std::size_t i = n; i >= pass; --i) a[i] += a[i - 1];
  }
  return a;
}

/// Signs of coefficients, 0 within `noise`: the first and the last, how often they change, whether there are any.
struct Signs {
  int first = 0, last = 0, changes = 0;
  bool positive = false, negative = false;
};

template <class T>
Signs signs(const std::vector<T>& b, const T& noise) {
  Signs s;
  int previous = 0;
  for (const T& x : b) {
    s.last = x > noise ? 1 : x < -noise ? -1 : 0;
    if (&x == &b.front()) s.first = s.last;
    if (s.last * previous < 0) ++s.changes;
    if (s.last != 0) previous = s.last;
    s.positive = s.positive || s.last > 0;
    s.negative = s.negative || s.last < 0;
  }
  return s;
}

/// The one root in [low, high] at whose ends the polynomial has opposite signs: bisection until Newton's steps stay
/// inside.
template <class T>
T refine(const std::vector<T>& power, T low, T high) {
  using std::abs;
  std::vector<T> slope;
  for (std::size_t k = 1; k < power.size(); ++k) slope.push_back(T(static_cast<int>(k)) * power[k]);
  const bool falling = value_at(power, low) > 0;
  T x = (low + high) / 2;
  for (int step = 0; step < 400; ++step) {
    const T f = value_at(power, x), change = f / value_at(slope, x);
    ((f > 0) == falling ? low : high) = x;
    T next = x - change;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (abs(next - x) <= std::numeric_limits<T>::epsilon() * abs(next)) return next;
    x = next;
  }
  return x;
}

template <class T>
std::optional<T> first_root(const std::vector<T>& power, const std::vector<T>& b, const T& low, const T& high,
                            const T& noise) {
  const Signs s = signs(b, noise);
  if (!s.negative) return std::nullopt;
  if (!s.positive && s.last < 0) return low;  // zero there, and falls at once
  if (s.first > 0 && s.last < 0 && s.changes == 1) return refine(power, low, high);
  if (high - low < zero_tolerance<T>()) return low;  // a root that is as good as double: grazing
  const T middle = (low + high) / 2;
  std::vector<T> left = b, right = b;  // de Casteljau
  for (std::size_t pass = 1; pass < b.size(); ++pass) {
    for (std::size_t i = b.size() - 1; i >= pass; --i) left[i] = (left[i] + left[i - 1]) / 2;
    for (std::size_t i = 0; i + pass < b.size(); ++i) right[i] = (right[i] + right[i + 1]) / 2;
  }
  const auto found = first_root(power, left, low, middle, noise);
  return found ? found : first_root(power, right, middle, high, noise);
}

}  // namespace detail

/// The least root in (0, 1] of a_0 + a_1 x + ...; 0 if that is negative just after 0. Leading coefficients that are
/// rounding (zero_tolerance of the sum of all magnitudes) count as zero: the root at 0 itself is where the caller comes
/// from. Descartes' rule in Bernstein's basis; a double root counts when the polynomial dips below -(that rounding).
/// `zero`: what counts as rounding of a_0, if the caller knows better. Nothing if there is none, or the polynomial is
/// zero.
template <class T>
std::optional<T> first_root(std::vector<T> a, const T& zero = T(0)) {
  using std::abs;
  T size(0);
  for (const T& x : a) size += abs(x);
  const T noise = zero_tolerance<T>() * size;
  std::size_t first = 0;
  while (first < a.size() && abs(a[first]) <= (first == 0 ? std::max(noise, zero) : noise)) ++first;
  a.erase(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(first));  // divided by x^first
  if (a.empty()) return std::nullopt;
  if (a.front() < 0) return T(0);
  const std::vector<T> b = detail::bernstein(a);
  const auto root = detail::first_root(a, b, T(0), T(1), noise);
  if (root || b.size() < 2) return root;
  return abs(b.back()) <= noise && b[b.size() - 2] > noise ? std::optional<T>(1) : std::nullopt;
}

}  // namespace slideway::oracle
