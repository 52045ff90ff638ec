// Random things from a sequence of bytes: one way to draw them for RapidCheck, which shrinks the bytes, and for
// fuzzing, which mutates them. A sequence that is used up gives zeros, and zero is always the simplest choice.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slideway::properties {

class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool used_up() const { return bytes_.empty(); }

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }

  /// 0 .. n - 1; n <= 256.
  int below(int n) { return byte() % n; }
  bool flag() { return below(2) != 0; }

  /// A dyadic number: an integer of at most 7 bits over 2^places, places <= 8. Sums of a few products of these are
  /// exact in doubles, and short in rationals. 0, -1, 1, -2, .. over 2^places in the order of the bytes.
  double dyadic(int places) { return std::ldexp(integer(), -places); }
  /// The same of at most 15 bits, over 2^places.
  double fine_dyadic(int places) {
    const int high = integer();
    return std::ldexp(high * 256 + byte(), -places);
  }
  /// > 0: (1 .. 128) / 2^places.
  double positive(int places) { return std::ldexp(1 + byte() / 2, -places); }
  /// -64 .. 63 as 0, -1, 1, -2, ..; -128 .. 127 for all bytes.
  int integer() {
    const int code = byte();
    return (code & 1) != 0 ? -(code + 1) / 2 : code / 2;
  }
  /// Any double at all, NaN among them.
  double any_double() {
    std::uint64_t bits = 0;
    for (int k = 0; k < 8; ++k) bits = bits << 8 | byte();
    double value;
    static_assert(sizeof value == sizeof bits);
    __builtin_memcpy(&value, &bits, sizeof value);
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace slideway::properties
