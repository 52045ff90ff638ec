// Poses, velocities and known accelerations of all bodies and of the contacts: one pass from the ground outwards.
//
// "Known" acceleration is what is left with the free q'' at zero: centripetal and Coriolis terms, and what the drives
// prescribe. The free q'' are what acceleration.hpp solves for.
#pragma once

#include <slideway/arithmetic.hpp>
#include <slideway/state.hpp>
#include <slideway/structure.hpp>

#include <cmath>

namespace slideway {

SLIDEWAY_INLINE constexpr Vec2 operator+(Vec2 a, Vec2 b) noexcept { return {a.x + b.x, a.y + b.y}; }
SLIDEWAY_INLINE constexpr Vec2 operator-(Vec2 a, Vec2 b) noexcept { return {a.x - b.x, a.y - b.y}; }
SLIDEWAY_INLINE constexpr Vec2 operator*(double s, Vec2 r) noexcept { return {s * r.x, s * r.y}; }
SLIDEWAY_INLINE constexpr double dot(Vec2 a, Vec2 b) noexcept { return a.x * b.x + a.y * b.y; }
SLIDEWAY_INLINE constexpr double cross(Vec2 a, Vec2 b) noexcept { return a.x * b.y - a.y * b.x; }
/// r turned by +90 degrees.
SLIDEWAY_INLINE constexpr Vec2 perp(Vec2 r) noexcept { return {-r.y, r.x}; }

struct Rotation {
  double c, s;
};

SLIDEWAY_INLINE constexpr Rotation operator*(Rotation a, Rotation b) noexcept {
  return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}
SLIDEWAY_INLINE constexpr Vec2 operator*(Rotation R, Vec2 r) noexcept {
  return {R.c * r.x - R.s * r.y, R.s * r.x + R.c * r.y};
}

/// R r for a fixed r with known zeros.
SLIDEWAY_INLINE constexpr Vec2 rotate(Rotation R, Vec2 r, Axes axes) noexcept {
  if (axes.x && axes.y) return R * r;
  if (axes.x) return {R.c * r.x, R.s * r.x};
  if (axes.y) return {-(R.s * r.y), R.c * r.y};
  return {};
}

/// Rot(angle). The angle is hidden from the compiler: g++ folds sin and cos of constants with other bits than the C
/// library gives at run time.
SLIDEWAY_INLINE Rotation rotation(double angle) noexcept {
#if defined(__GNUC__) && defined(__x86_64__)
  asm("" : "+x"(angle));
#elif defined(__GNUC__)
  asm("" : "+m"(angle));
#endif
  return {std::cos(angle), std::sin(angle)};
}

/// A sum whose absent terms cost nothing.
struct Sum {
  Vec2 value{};
  bool any = false;
  SLIDEWAY_INLINE constexpr void add(Vec2 term) noexcept {
    value = any ? value + term : term;
    any = true;
  }
};

template <class Size>
struct Kinematics {
  static constexpr int n_bodies = at_least_one(Size::bodies);
  Rotation frame[n_bodies];      ///< of the joint: what the slides follow
  Rotation turn[n_bodies];       ///< of the body
  Vec2 arm[n_bodies];            ///< from the parent's origin to the body's, m
  Vec2 origin[n_bodies];         ///< m
  double rate[n_bodies];         ///< omega, rad/s
  double known_alpha[n_bodies];  ///< rad/s^2
  Vec2 velocity[n_bodies];       ///< of the origin, m/s
  Vec2 known[n_bodies];          ///< acceleration of the origin, m/s^2
};

/// The axis of a sliding coordinate, world's frame.
SLIDEWAY_INLINE constexpr Vec2 axis(Rotation frame, Motion motion) noexcept {
  return motion == Motion::slide_x ? Vec2{frame.c, frame.s} : Vec2{-frame.s, frame.c};
}

/// Poses, velocities and known accelerations from q, q' and the driven entries of `prescribed` (q'' by coordinate).
/// Linear in the bodies; one sine and cosine for each turning coordinate.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void kinematics(const Source& source, const double* q, const double* v, const double* prescribed,
                                Kinematics<Size>& k) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  for_each<Source, Size::bodies>(scene.bodies, [&](int i) SLIDEWAY_FOLD {
    const Body& body = scene.body[i];
    const int p = body.parent, j = table.first[i];
    const bool grounded = p == ground;
    const bool planar = body.joint == Joint::planar, slides = planar || body.joint == Joint::prismatic;
    const bool turns = planar || body.joint == Joint::revolute;
    const int turn_j = planar ? j + 2 : j;

    const Rotation fixed{body.turn.x, body.turn.y};
    const Rotation frame = grounded ? fixed : table.turned[i] ? k.turn[p] * fixed : k.turn[p];
    k.frame[i] = frame;
    if (turns) {
      const Rotation own = rotation(q[turn_j]);
      k.turn[i] = grounded && !table.turned[i] ? own : frame * own;
    } else {
      k.turn[i] = frame;
    }

    Vec2 arm = grounded ? body.at : rotate(k.turn[p], body.at, table.at[i]);
    if (slides) arm = arm + q[j] * axis(frame, Motion::slide_x);
    if (planar) arm = arm + q[j + 1] * axis(frame, Motion::slide_y);
    k.arm[i] = arm;
    k.origin[i] = grounded ? arm : k.origin[p] + arm;

    const bool carried_round = !grounded && table.turning[p];
    const bool known_round = !grounded && table.known_turning[p];
    k.rate[i] = !turns ? (carried_round ? k.rate[p] : 0) : carried_round ? k.rate[p] + v[turn_j] : v[turn_j];
    const bool prescribed_turn = turns && table.drive_of[turn_j] != none;
    k.known_alpha[i] = !prescribed_turn ? (known_round ? k.known_alpha[p] : 0)
                       : known_round    ? k.known_alpha[p] + prescribed[turn_j]
                                        : prescribed[turn_j];

    Sum velocity, known;
    if (!grounded && table.moving[p]) {
      velocity.add(k.velocity[p]);
      known.add(k.known[p]);
    }
    if (carried_round && (slides || table.at[i].any())) {
      velocity.add(k.rate[p] * perp(arm));
      known.add(-(k.rate[p] * k.rate[p]) * arm);
      if (known_round) known.add(k.known_alpha[p] * perp(arm));
    }
    const auto slide = [&](Motion motion, int c) SLIDEWAY_FOLD {
      const Vec2 along = axis(frame, motion);
      velocity.add(v[c] * along);
      if (carried_round) known.add(2 * k.rate[p] * v[c] * perp(along));
      if (table.drive_of[c] != none) known.add(prescribed[c] * along);
    };
    if (slides) slide(Motion::slide_x, j);
    if (planar) slide(Motion::slide_y, j + 1);
    k.velocity[i] = velocity.value;
    k.known[i] = known.value;
  });
}

/// A point fixed to body i: where it is relative to the body's origin, and how it moves.
struct Point {
  Vec2 rho, place, velocity, known;
};

/// The material point of body i at rho from its origin (world's frame). The ground's points are at rest.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE Point point(const Source& source, const Kinematics<Size>& k, int i, Vec2 rho,
                            bool off_origin) noexcept {
  if (i == ground) return {rho, rho, {}, {}};
  const auto& table = source.tables;
  Sum velocity, known;
  if (table.moving[i]) {
    velocity.add(k.velocity[i]);
    known.add(k.known[i]);
  }
  if (table.turning[i] && off_origin) {
    velocity.add(k.rate[i] * perp(rho));
    known.add(-(k.rate[i] * k.rate[i]) * rho);
    if (table.known_turning[i]) known.add(k.known_alpha[i] * perp(rho));
  }
  return {rho, k.origin[i] + rho, velocity.value, known.value};
}

/// The material point of body i at `at` in its own frame.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE Point point_at(const Source& source, const Kinematics<Size>& k, int i, Vec2 at, Axes axes) noexcept {
  return point(source, k, i, i == ground ? at : rotate(k.turn[i], at, axes), axes.any());
}

/// A guide's contacts. t is the guide's direction, n = perp t; Phi = n . (r - r_rail); gamma is what Phi'' is with the
/// free q'' at zero, so that Phi'' = N q'' + gamma (WWZ14 (1), twice differentiated):
///   Phi' = n . w,  gamma = n . (known acceleration of the slider's point against the rail's) - 2 omega_rail t . w,
/// with w the velocity of the slider's point against the rail's material point at the same place; t . w is the sliding
/// speed. The second contact lies (along, across) from the first in the frame (t, n), and with Omega and A the rate and
/// the known angular acceleration of the slider against the rail
///   Phi_1 = Phi_0 + across,  Phi_1' = Phi_0' + Omega along,  slip_1 = slip_0 - Omega across,
///   gamma_1 = gamma_0 + A along - Omega^2 across.
struct Sliding {
  Vec2 t, n;                ///< world's frame
  Vec2 on_slider, on_rail;  ///< the first contact from the slider's and from the rail's origin, m
  Vec2 place;               ///< of the first contact, m
  double along, across;     ///< m
  double Phi[2], Phi_rate[2], gamma[2];
  double slip[2];  ///< T q', m/s
};

/// The contacts of guide g. Constant time.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void sliding(const Source& source, const Kinematics<Size>& k, int g, Sliding& s) noexcept {
  const auto& table = source.tables;
  const Guide& guide = source.scene.guide[g];
  const int rail = guide.rail, slider = guide.slider;
  const bool rail_turns = rail != ground && table.turning[rail];
  s.t = rail == ground ? guide.tangent : rotate(k.turn[rail], guide.tangent, table.tangent[g]);
  s.n = perp(s.t);
  const Point a = point_at(source, k, slider, guide.contact[0], table.contact[g]);
  s.on_slider = a.rho;
  s.place = a.place;
  s.on_rail = rail == ground ? a.place : a.place - k.origin[rail];
  const Vec2 start = rail == ground ? guide.origin : rotate(k.turn[rail], guide.origin, table.origin[g]);
  s.Phi[0] = dot(s.n, table.origin[g].any() ? s.on_rail - start : s.on_rail);
  const bool rail_rests = rail == ground || !(rail_turns || table.moving[rail]);
  const Point b = point(source, k, rail, s.on_rail, true);
  const Vec2 w = rail_rests ? a.velocity : a.velocity - b.velocity;
  s.slip[0] = dot(s.t, w);
  s.Phi_rate[0] = dot(s.n, w);
  const double relative = dot(s.n, rail_rests ? a.known : a.known - b.known);
  s.gamma[0] = rail_turns ? relative - 2 * k.rate[rail] * s.slip[0] : relative;
  s.along = s.across = 0;
  if (guide.contacts == 1) return;

  const Vec2 span = rotate(k.turn[slider], table.span[g], table.span_axes[g]);
  s.along = dot(s.t, span);
  s.across = dot(s.n, span);
  const double Omega = rail_turns ? k.rate[slider] - k.rate[rail] : k.rate[slider];
  s.Phi[1] = s.Phi[0] + s.across;
  s.Phi_rate[1] = s.Phi_rate[0] + Omega * s.along;
  s.slip[1] = s.slip[0] - Omega * s.across;
  s.gamma[1] = s.gamma[0] - Omega * Omega * s.across;
  const bool rail_known = rail != ground && table.known_turning[rail];
  if (table.known_turning[slider]) s.gamma[1] += k.known_alpha[slider] * s.along;
  if (rail_known) s.gamma[1] -= k.known_alpha[rail] * s.along;
}

/// Acceleration of the sliding speed with the free q'' at zero, so that v' = T q'' + this: with w and omega as above,
/// t' = omega n, and the rail's material point at the contact changes by omega perp w beside its own acceleration:
/// t . (known acceleration of the slider's point against the rail's) + 2 omega_rail Phi'. m/s^2; constant time.
template <class Source, class Size = typename Source::Size>
double sliding_gamma(const Source& source, const Kinematics<Size>& k, int g, const Sliding& s) noexcept {
  const Guide& guide = source.scene.guide[g];
  const Vec2 a = point(source, k, guide.slider, s.on_slider, true).known;
  const Vec2 b = point(source, k, guide.rail, s.on_rail, true).known;
  const bool rail_turns = guide.rail != ground && source.tables.turning[guide.rail];
  return dot(s.t, a - b) + (rail_turns ? 2 * k.rate[guide.rail] * s.Phi_rate[0] : 0);
}

/// The two points of a pin, seen from body b: Phi = r_a - r_b, and with w the velocity of a's point against b's
/// material point at the same place, Phi'' = (accelerations' difference) - 2 omega_b perp w, as for a guide. So
/// the pin's forces on a and b act at one place and cancel, drift or not.
struct Meeting {
  Vec2 on_a, on_b;  ///< from the bodies' origins to a's point, m
  Vec2 place;
  Vec2 Phi, rate, gamma;
};

/// The points of pin p. Constant time.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void meeting(const Source& source, const Kinematics<Size>& k, int p, Meeting& m) noexcept {
  const Pin& pin = source.scene.pin[p];
  const Point a = point_at(source, k, pin.a, pin.a_at, {true, true});
  m.on_a = a.rho;
  m.place = a.place;
  m.on_b = pin.b == ground ? a.place : a.place - k.origin[pin.b];
  m.Phi = m.on_b - (pin.b == ground ? pin.b_at : k.turn[pin.b] * pin.b_at);
  const Point b = point(source, k, pin.b, m.on_b, true);
  m.rate = a.velocity - b.velocity;
  m.gamma = a.known - b.known;
  if (pin.b != ground && source.tables.turning[pin.b]) m.gamma = m.gamma - (2 * k.rate[pin.b]) * perp(m.rate);
}

/// Column of a coordinate in the relative Jacobian of two bodies' material points at one place: side times the
/// velocity that a unit speed of the coordinate gives. d: from the origin of the coordinate's body to the place.
SLIDEWAY_INLINE constexpr Vec2 column(Motion motion, Rotation frame, Vec2 d, int side) noexcept {
  const Vec2 one = motion == Motion::turn ? perp(d) : axis(frame, motion);
  return side > 0 ? one : Vec2{-one.x, -one.y};
}

}  // namespace slideway
