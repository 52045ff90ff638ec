// What may not change a motion: the same mechanism seen in a mirror, turned, with guides read backwards, with its items
// listed in another order, in other units, beside another one. Each takes a scene to another and a state to the one
// that it has there.
#pragma once

#include <functional>
#include <slideway/properties/mechanism.hpp>
#include <slideway/properties/step.hpp>
#include <vector>

namespace slideway::properties {

struct Seen {
  MechanismScene scene;
  std::function<RunState(const RunState&)> state;  ///< of the mechanism -> of the one seen; signs are left undecided
  double time = 1;                                 ///< a second there, per second
};

/// y -> -y. Every number is the same or its negative: so is every bit of the motion.
Seen mirrored(const MechanismScene& scene);
/// The world turned by a quarter, gravity with it. Sums of squares are added in another order.
Seen turned(const MechanismScene& scene);
/// Directions of all guides reversed: slip, friction and contact forces change their signs, and no bit of the motion.
Seen with_guides_reversed(const MechanismScene& scene);
/// The guides in the order given, and bodies sorted anew as far as parents stay before their children.
Seen reordered(const MechanismScene& scene, const std::vector<int>& guides);
/// Units of length, mass and time smaller by 2^length, 4^mass, 2^time: every number is another by a power of two, roots
/// of masses too, and no bit of the motion.
Seen in_units(const MechanismScene& scene, int length, int mass, int time);
/// The mechanism twice, neither touching the other: no bit of the motion. Requires room for it.
Seen doubled(const MechanismScene& scene);

}  // namespace slideway::properties
