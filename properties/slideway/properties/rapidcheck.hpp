// The draws as RapidCheck generators: RC_GTEST_PROP(.., .., (const HlcpCase& problem)) tries problems of every kind,
// and makes one that fails small.
#pragma once

#include <gtest/gtest.h>
// GoogleTest comes first.
#include <rapidcheck/gtest.h>

#include <slideway/properties/hlcp.hpp>
#include <slideway/properties/mechanism.hpp>
#include <vector>

namespace slideway::properties {

/// draw(Choices&), from bytes that shrink. `longest`: the most bytes that are of use.
template <class Draw>
auto drawn(std::size_t longest, Draw draw) {
  // RapidCheck's sizes grow from 0 to 100: small cases first.
  return rc::gen::withSize([=](int size) {
    const auto bytes = 4 + longest * static_cast<std::size_t>(size) / 100;
    return rc::gen::map(
        rc::gen::container<std::vector<std::uint8_t>>(bytes, rc::gen::resize(100, rc::gen::arbitrary<std::uint8_t>())),
        [=](const std::vector<std::uint8_t>& drawn_bytes) {
          Choices choices(drawn_bytes);
          return draw(choices);
        });
  });
}

/// Problems of one kind, of order 1 to most_order.
inline rc::Gen<HlcpCase> hlcp(HlcpKind kind, int most_order) {
  return drawn(static_cast<std::size_t>(3 * most_order * most_order + 16),
               [=](Choices& choices) { return draw_hlcp(choices, kind, most_order); });
}

/// The same, LCPs only: for solvers that take no others.
inline rc::Gen<HlcpCase> lcp(int most_order) { return hlcp(HlcpKind::lcp, most_order); }

inline void showValue(const HlcpCase& problem, std::ostream& out) { out << json(problem); }

/// As a scene file, to be run by `slideway run`.
inline void showValue(const Mechanism& mechanism, std::ostream& out) {
  out << "# " << name(mechanism.stratum) << (mechanism.assembled ? "\n" : ", not assembled\n") << toml(mechanism.scene);
}

}  // namespace slideway::properties

namespace rc {

/// Of every kind, up to order 5.
template <>
struct Arbitrary<slideway::properties::HlcpCase> {
  static Gen<slideway::properties::HlcpCase> arbitrary() {
    using namespace slideway::properties;
    return slideway::properties::drawn(128, [](Choices& choices) {
      const auto kind = static_cast<HlcpKind>(choices.below(hlcp_kinds));
      return draw_hlcp(choices, kind, 5);
    });
  }
};

template <>
struct Arbitrary<slideway::properties::Mechanism> {
  static Gen<slideway::properties::Mechanism> arbitrary() {
    using namespace slideway::properties;
    return slideway::properties::drawn(mechanism_bytes, [](Choices& choices) { return draw_mechanism(choices); });
  }
};

}  // namespace rc
