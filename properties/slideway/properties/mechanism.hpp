// Random mechanisms that are valid by construction: trees with every joint, up to six guides, pins, drives, springs and
// loads, assembled at their start; and states of them on, beside and far from the points where friction has a kink.
#pragma once

#include <slideway/io/stepper.hpp>
#include <slideway/properties/choices.hpp>
#include <string>

namespace slideway::properties {

using MechanismScene = Scene<io::RunSize>;

/// Where a state is. Each method has to get all three right.
enum class Stratum {
  generic,
  on_kink,  ///< a sliding speed or all forces are zero, or friction at rest is at its limit, as exactly as doubles go
  beside    ///< 1e-8 of that beside it
};
const char* name(Stratum stratum);

struct Mechanism {
  MechanismScene scene;  ///< its bodies' q and v are the state
  Stratum stratum = Stratum::generic;
  bool assembled = false;  ///< guides and pins hold at q and v, to rounding; false where that needs what they lack
};

/// Up to 5 bodies. Lengths and masses are dyadic, some metres and kilograms. Used-up choices: one body that slides.
Mechanism draw_mechanism(Choices& choices);
inline constexpr int mechanism_bytes = 256;  ///< more are never used

/// As a scene file, all digits: what `slideway run` and `verify` read.
std::string toml(const MechanismScene& scene);

}  // namespace slideway::properties
