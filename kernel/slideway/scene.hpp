// A scene: plain literal data that describes a mechanism, and the defects that such data can have.
//
// Frames. A body's frame has its origin at its joint. With R_p, o_p the turn and origin of the parent's frame:
//   revolute   R = R_p Rot(angle) Rot(q)      o = o_p + R_p at
//   prismatic  R = R_p Rot(angle)             o = o_p + R_p at + R (q, 0)
//   planar     R = R_p Rot(angle) Rot(q[2])   o = o_p + R_p at + R_p Rot(angle) (q[0], q[1])
//   fixed      R = R_p Rot(angle)             o = o_p + R_p at
// Units are SI throughout; -1 as an index means the ground.
#pragma once

#include <slideway/status.hpp>

namespace slideway {

struct Vec2 {
  double x, y;
};

inline constexpr int ground = -1;
inline constexpr int none = -1;

enum class Joint : unsigned char { revolute, prismatic, planar, fixed };
enum class Law : unsigned char { uniform, harmonic, polynomial, input };

struct Body {
  int parent = ground;  ///< "ground" or an earlier body
  Joint joint = Joint::revolute;
  Vec2 at{};                ///< the joint's place in the parent's frame, m
  double angle = 0;         ///< fixed turn of the joint's frame against the parent's, rad
  Vec2 turn{1, 0};          ///< (cos angle, sin angle): trigonometry is done once, by whoever makes the scene
  double mass = 0;          ///< kg
  Vec2 com{};               ///< centre of mass in the body's frame, m
  double inertia = 0;       ///< about the centre of mass, kg m^2
  double q[3] = {0, 0, 0};  ///< start: rad | m | m, m, rad
  double v[3] = {0, 0, 0};  ///< start speeds, per second
};

/// The frictional translational joint: contact points of the slider stay on a line of the rail.
struct Guide {
  int slider = 0;  ///< carries the contact points
  int rail = ground;
  Vec2 origin{};         ///< a point of the line, rail's frame, m
  Vec2 direction{1, 0};  ///< of the line, rail's frame, any length
  Vec2 tangent{1, 0};    ///< direction over its length, made with `direction`
  int contacts = 1;      ///< one or two: a straight guide removes two degrees of freedom
  Vec2 contact[2] = {};  ///< slider's frame, m
  double mu = 0;         ///< kinetic coefficient of friction
  double mu_static = 0;  ///< static coefficient, >= mu
  double viscous = 0;    ///< N s/m
  double preload = 0;    ///< N, friction that is there without load
};

/// A rheonomic constraint: one coordinate of a body follows a law.
///   uniform     c[0] + c[1] t
///   polynomial  c[0] + c[1] t + ... + c[terms-1] t^(terms-1)
///   harmonic    c[0] + c[1] sin(c[2] t + c[3])
///   input       value, rate and acceleration given with each step
struct Drive {
  int body = 0;
  int axis = 0;  ///< of a planar body: 0 x, 1 y, 2 angle
  Law law = Law::uniform;
  int terms = 2;
  double c[8] = {};
  int input = none;
};

/// Two points coincide.
struct Pin {
  int a = 0, b = ground;
  Vec2 a_at{}, b_at{};
};

/// A spring between two points, with damping along it.
struct Spring {
  int a = 0, b = ground;
  Vec2 a_at{}, b_at{};
  double stiffness = 0;  ///< N/m
  double length = 0;     ///< free length, m
  double damping = 0;    ///< N s/m
};

/// A spring on a revolute or prismatic coordinate.
struct JointSpring {
  int body = 0;
  double stiffness = 0;  ///< N m/rad | N/m
  double rest = 0;       ///< rad | m
  double damping = 0;    ///< N m s/rad | N s/m
};

/// A force and a torque on a body; with an input, scaled by its value.
struct Load {
  int body = 0;
  Vec2 at{};     ///< body's frame, m
  Vec2 force{};  ///< world's frame, N
  double torque = 0;
  int input = none;
};

/// Room for each kind of item. Coordinates: revolute and prismatic 1, planar 3, fixed 0.
template <int Bodies, int Coordinates, int Guides, int Contacts, int Drives, int Pins, int Springs, int JointSprings,
          int Loads, int Inputs>
struct Size {
  static constexpr int bodies = Bodies, coordinates = Coordinates, guides = Guides, contacts = Contacts,
                       drives = Drives, pins = Pins, springs = Springs, joint_springs = JointSprings, loads = Loads,
                       inputs = Inputs;
};

constexpr int at_least_one(int n) noexcept { return n > 0 ? n : 1; }

/// A mechanism. What a count leaves out of an array is not part of the scene.
template <class Size_>
struct Scene {
  using Size = Size_;
  Vec2 gravity{};                 ///< m/s^2
  double alpha = 20, beta = 100;  ///< Baumgarte: Phi'' + alpha Phi' + beta Phi = 0, 1/s and 1/s^2
  int bodies = 0, guides = 0, drives = 0, pins = 0, springs = 0, joint_springs = 0, loads = 0, inputs = 0;
  Body body[at_least_one(Size::bodies)] = {};
  Guide guide[at_least_one(Size::guides)] = {};
  Drive drive[at_least_one(Size::drives)] = {};
  Pin pin[at_least_one(Size::pins)] = {};
  Spring spring[at_least_one(Size::springs)] = {};
  JointSpring joint_spring[at_least_one(Size::joint_springs)] = {};
  Load load[at_least_one(Size::loads)] = {};
};

constexpr int coordinates(Joint joint) noexcept { return joint == Joint::planar ? 3 : joint == Joint::fixed ? 0 : 1; }

template <class Size>
constexpr int coordinates(const Scene<Size>& scene) noexcept {
  int n = 0;
  for (int i = 0; i < scene.bodies; ++i) n += coordinates(scene.body[i].joint);
  return n;
}

template <class Size>
constexpr int contacts(const Scene<Size>& scene) noexcept {
  int n = 0;
  for (int g = 0; g < scene.guides; ++g) n += scene.guide[g].contacts;
  return n;
}

// --- defects ---------------------------------------------------------------------------------------------------------

enum class Item : unsigned char { scene, body, guide, drive, pin, spring, joint_spring, load };

enum class Defect : unsigned char {
  too_large,
  not_finite,
  parent_not_earlier,
  negative_mass,
  negative_inertia,
  turn_not_a_rotation,
  no_such_body,
  no_such_input,
  same_body,
  contact_count,
  no_direction,
  tangent_not_unit,
  negative_mu,
  mu_static_below_mu,
  negative_viscous,
  negative_preload,
  no_such_coordinate,
  driven_twice,
  coefficient_count,
  negative_stiffness,
  negative_length,
  negative_damping,
  negative_gain
};

/// What is wrong and what to write instead, in one clause.
constexpr const char* sentence(Defect defect) noexcept {
  switch (defect) {
    case Defect::too_large:
      return "has more items than there is room for";
    case Defect::not_finite:
      return "has a value that is not a finite number";
    case Defect::parent_not_earlier:
      return "needs a parent that is \"ground\" or an earlier body";
    case Defect::negative_mass:
      return "needs mass >= 0";
    case Defect::negative_inertia:
      return "needs inertia >= 0";
    case Defect::turn_not_a_rotation:
      return "needs turn = (cos angle, sin angle)";
    case Defect::no_such_body:
      return "names a body that does not exist";
    case Defect::no_such_input:
      return "names an input that does not exist";
    case Defect::same_body:
      return "needs two different bodies";
    case Defect::contact_count:
      return "needs one or two contacts: a third on a straight line is always redundant";
    case Defect::no_direction:
      return "needs a direction that is not zero";
    case Defect::tangent_not_unit:
      return "needs tangent = direction / |direction|";
    case Defect::negative_mu:
      return "needs mu >= 0";
    case Defect::mu_static_below_mu:
      return "needs mu_static >= mu";
    case Defect::negative_viscous:
      return "needs viscous >= 0";
    case Defect::negative_preload:
      return "needs preload >= 0";
    case Defect::no_such_coordinate:
      return "needs a coordinate that the body's joint has";
    case Defect::driven_twice:
      return "drives a coordinate that an earlier drive drives";
    case Defect::coefficient_count:
      return "needs one to eight coefficients";
    case Defect::negative_stiffness:
      return "needs stiffness >= 0";
    case Defect::negative_length:
      return "needs length >= 0";
    case Defect::negative_damping:
      return "needs damping >= 0";
    case Defect::negative_gain:
      return "needs alpha >= 0 and beta >= 0";
  }
  return "is defective";
}

struct Finding {
  Item item = Item::scene;
  int index = 0;
  Defect defect = Defect::too_large;
};

/// All defects found, in the order of the scene; those beyond the room are counted, not kept.
struct Findings {
  static constexpr int room = 64;
  int count = 0;
  Finding finding[room] = {};
  constexpr void add(Item item, int index, Defect defect) noexcept {
    if (count < room) finding[count] = {item, index, defect};
    ++count;
  }
  constexpr void require(bool good, Item item, int index, Defect defect) noexcept {
    if (!good) add(item, index, defect);
  }
};

namespace detail {

constexpr double infinity = __builtin_huge_val();
constexpr double epsilon = 0x1p-52;

constexpr bool finite(double x) noexcept { return x - x == 0; }
constexpr bool finite(Vec2 r) noexcept { return finite(r.x) && finite(r.y); }
template <int N>
constexpr bool finite(const double (&x)[N]) noexcept {
  for (double value : x) {
    if (!finite(value)) return false;
  }
  return true;
}

/// |r|^2 = 1 to the rounding of two normalised components: 2 ulp each, squared and added.
constexpr bool unit(Vec2 r) noexcept {
  const double excess = r.x * r.x + r.y * r.y - 1;
  return excess <= 8 * epsilon && excess >= -8 * epsilon;
}

/// Does the unit vector t point as r does, to the rounding of the components of both?
constexpr bool along(Vec2 t, Vec2 r) noexcept {
  const double size = (r.x < 0 ? -r.x : r.x) + (r.y < 0 ? -r.y : r.y);
  const double cross = t.x * r.y - t.y * r.x;
  if (!finite(size)) return true;  // a defect of its own
  return cross <= 8 * epsilon * size && cross >= -8 * epsilon * size && t.x * r.x + t.y * r.y >= 0;
}

}  // namespace detail

/// Every defect that the data show without trigonometry. The mass matrix and the start pose are checked where they are
/// computed. Linear in the items but for driven_twice.
template <class Size>
constexpr Findings defects(const Scene<Size>& scene) noexcept {
  using detail::finite;
  Findings found;
  const auto body_exists = [&](int i) { return i >= 0 && i < scene.bodies; };
  const auto body_or_ground = [&](int i) { return i == ground || body_exists(i); };
  const auto input_exists = [&](int i) { return i >= 0 && i < scene.inputs; };

  found.require(scene.bodies <= Size::bodies && scene.guides <= Size::guides && scene.drives <= Size::drives &&
                    scene.pins <= Size::pins && scene.springs <= Size::springs &&
                    scene.joint_springs <= Size::joint_springs && scene.loads <= Size::loads &&
                    scene.inputs <= Size::inputs && scene.bodies >= 0 && scene.guides >= 0 && scene.drives >= 0 &&
                    scene.pins >= 0 && scene.springs >= 0 && scene.joint_springs >= 0 && scene.loads >= 0 &&
                    scene.inputs >= 0,
                Item::scene, 0, Defect::too_large);
  if (found.count > 0) return found;  // nothing beyond the arrays may be read
  found.require(coordinates(scene) <= Size::coordinates && contacts(scene) <= Size::contacts, Item::scene, 0,
                Defect::too_large);
  found.require(finite(scene.gravity) && finite(scene.alpha) && finite(scene.beta), Item::scene, 0, Defect::not_finite);
  found.require(!(scene.alpha < 0) && !(scene.beta < 0), Item::scene, 0, Defect::negative_gain);

  for (int i = 0; i < scene.bodies; ++i) {
    const Body& body = scene.body[i];
    found.require(body.parent >= ground && body.parent < i, Item::body, i, Defect::parent_not_earlier);
    found.require(finite(body.at) && finite(body.angle) && finite(body.turn) && finite(body.mass) && finite(body.com) &&
                      finite(body.inertia) && finite(body.q) && finite(body.v),
                  Item::body, i, Defect::not_finite);
    found.require(detail::unit(body.turn) && (body.angle == 0) == (body.turn.x == 1 && body.turn.y == 0), Item::body, i,
                  Defect::turn_not_a_rotation);
    found.require(!(body.mass < 0), Item::body, i, Defect::negative_mass);
    found.require(!(body.inertia < 0), Item::body, i, Defect::negative_inertia);
  }
  for (int g = 0; g < scene.guides; ++g) {
    const Guide& guide = scene.guide[g];
    found.require(body_exists(guide.slider) && body_or_ground(guide.rail), Item::guide, g, Defect::no_such_body);
    found.require(guide.slider != guide.rail, Item::guide, g, Defect::same_body);
    found.require(guide.contacts == 1 || guide.contacts == 2, Item::guide, g, Defect::contact_count);
    found.require(finite(guide.origin) && finite(guide.direction) && finite(guide.tangent) &&
                      finite(guide.contact[0]) && finite(guide.contact[1]) && finite(guide.mu) &&
                      finite(guide.mu_static) && finite(guide.viscous) && finite(guide.preload),
                  Item::guide, g, Defect::not_finite);
    found.require(guide.direction.x != 0 || guide.direction.y != 0, Item::guide, g, Defect::no_direction);
    found.require(detail::unit(guide.tangent) && detail::along(guide.tangent, guide.direction), Item::guide, g,
                  Defect::tangent_not_unit);
    found.require(!(guide.mu < 0), Item::guide, g, Defect::negative_mu);
    found.require(!(guide.mu_static < guide.mu), Item::guide, g, Defect::mu_static_below_mu);
    found.require(!(guide.viscous < 0), Item::guide, g, Defect::negative_viscous);
    found.require(!(guide.preload < 0), Item::guide, g, Defect::negative_preload);
  }
  for (int d = 0; d < scene.drives; ++d) {
    const Drive& drive = scene.drive[d];
    found.require(finite(drive.c), Item::drive, d, Defect::not_finite);
    found.require(drive.terms >= 1 && drive.terms <= 8, Item::drive, d, Defect::coefficient_count);
    found.require(drive.law != Law::input || input_exists(drive.input), Item::drive, d, Defect::no_such_input);
    if (!body_exists(drive.body)) {
      found.add(Item::drive, d, Defect::no_such_body);
      continue;
    }
    found.require(drive.axis >= 0 && drive.axis < coordinates(scene.body[drive.body].joint), Item::drive, d,
                  Defect::no_such_coordinate);
    for (int e = 0; e < d; ++e) {
      found.require(scene.drive[e].body != drive.body || scene.drive[e].axis != drive.axis, Item::drive, d,
                    Defect::driven_twice);
    }
  }
  for (int p = 0; p < scene.pins; ++p) {
    const Pin& pin = scene.pin[p];
    found.require(body_exists(pin.a) && body_or_ground(pin.b), Item::pin, p, Defect::no_such_body);
    found.require(pin.a != pin.b, Item::pin, p, Defect::same_body);
    found.require(finite(pin.a_at) && finite(pin.b_at), Item::pin, p, Defect::not_finite);
  }
  for (int s = 0; s < scene.springs; ++s) {
    const Spring& spring = scene.spring[s];
    found.require(body_exists(spring.a) && body_or_ground(spring.b), Item::spring, s, Defect::no_such_body);
    found.require(spring.a != spring.b, Item::spring, s, Defect::same_body);
    found.require(finite(spring.a_at) && finite(spring.b_at) && finite(spring.stiffness) && finite(spring.length) &&
                      finite(spring.damping),
                  Item::spring, s, Defect::not_finite);
    found.require(!(spring.stiffness < 0), Item::spring, s, Defect::negative_stiffness);
    found.require(!(spring.length < 0), Item::spring, s, Defect::negative_length);
    found.require(!(spring.damping < 0), Item::spring, s, Defect::negative_damping);
  }
  for (int s = 0; s < scene.joint_springs; ++s) {
    const JointSpring& spring = scene.joint_spring[s];
    if (body_exists(spring.body)) {
      found.require(coordinates(scene.body[spring.body].joint) == 1, Item::joint_spring, s, Defect::no_such_coordinate);
    } else {
      found.add(Item::joint_spring, s, Defect::no_such_body);
    }
    found.require(finite(spring.stiffness) && finite(spring.rest) && finite(spring.damping), Item::joint_spring, s,
                  Defect::not_finite);
    found.require(!(spring.stiffness < 0), Item::joint_spring, s, Defect::negative_stiffness);
    found.require(!(spring.damping < 0), Item::joint_spring, s, Defect::negative_damping);
  }
  for (int l = 0; l < scene.loads; ++l) {
    const Load& load = scene.load[l];
    found.require(body_exists(load.body), Item::load, l, Defect::no_such_body);
    found.require(load.input == none || input_exists(load.input), Item::load, l, Defect::no_such_input);
    found.require(finite(load.at) && finite(load.force) && finite(load.torque), Item::load, l, Defect::not_finite);
  }
  return found;
}

}  // namespace slideway
