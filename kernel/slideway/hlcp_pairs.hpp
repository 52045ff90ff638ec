// What the HLCP solver computes with: bits of doubles, pairs of doubles, loops written out.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace slideway::hlcp_detail {

using Word = std::uint64_t;
typedef double Pair __attribute__((vector_size(16)));
typedef long long PairBits __attribute__((vector_size(16)));

inline Word bits(double value) noexcept {
  Word word;
  std::memcpy(&word, &value, sizeof word);
  return word;
}

inline double real(Word word) noexcept {
  double value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

inline constexpr Word sign_bit = Word{1} << 63;

/// 2^k for -1022 <= k <= 1023.
inline double power_of_two(int k) noexcept { return real(static_cast<Word>(k + 1023) << 52); }

inline Pair load(const double* from) noexcept {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

/// The same from numbers that were stored one by one just now: such a pair cannot be forwarded from the store buffer in
/// one piece.
inline Pair gather(const double* from) noexcept { return Pair{from[0], from[1]}; }

inline void store(double* to, Pair pair) noexcept { std::memcpy(to, &pair, sizeof pair); }

inline Pair magnitude(Pair pair) noexcept {
  constexpr long long rest = static_cast<long long>(~sign_bit);
  return (Pair)((PairBits)pair & PairBits{rest, rest});
}

inline constexpr PairBits sign_bits = {static_cast<long long>(sign_bit), static_cast<long long>(sign_bit)};

inline constexpr PairBits exponent_bits = {2047LL << 52, 2047LL << 52};
inline constexpr PairBits twice_bias = {2046LL << 52, 2046LL << 52};

/// The sums of both pairs.
inline Pair sums(Pair a, Pair b) noexcept { return Pair{a[0], b[0]} + Pair{a[1], b[1]}; }

/// `plus` where the mask is zero, `minus` where it is all ones.
inline Pair choose(Pair plus, Pair minus, PairBits mask) noexcept {
  return (Pair)((PairBits)plus ^ (((PairBits)plus ^ (PairBits)minus) & mask));
}

inline double either(bool first, double a, double b) noexcept {
  const Word mask = Word{0} - static_cast<Word>(first);
  return real((bits(a) & mask) | (bits(b) & ~mask));
}

/// (c, -|c|): one multiply-subtract then acts as L or U in the first lane and as its comparison matrix in the second.
inline Pair comparison(double c) noexcept {
  return (Pair)((PairBits)Pair{c, c} | PairBits{0, static_cast<long long>(sign_bit)});
}

template <int... I, class Body>
[[gnu::always_inline]] inline void each_of(std::integer_sequence<int, I...>, const Body& body) noexcept {
  (body(I), ...);
}

/// body(0), ..., body(n - 1); written out one by one when n is a constant, so that the loops inside have constant
/// bounds.
template <class Count, class Body>
[[gnu::always_inline]] inline void each(Count n, const Body& body) noexcept {
  if constexpr (std::is_same_v<Count, int>)
    for (int i = 0; i < n; ++i) body(i);
  else
    each_of(std::make_integer_sequence<int, Count::value>{}, body);
}

}  // namespace slideway::hlcp_detail
