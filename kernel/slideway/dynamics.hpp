// Mass matrix, applied and inertial forces, and what eliminates them: one pass from the leaves to the ground.
//
// For the free coordinates, M q'' = h + N' lambda + T' F + (ideal rows)' pi  [WWZ14 (10), with the drives' q'' known].
// M = G' G with G lower triangular over the tree (a coordinate meets only those between it and the ground), so that
// u = G q'' and rows x~ = G^-T x turn the mass metric into the Euclidean one: S = N~ N~'.
#pragma once

#include <slideway/drive.hpp>

namespace slideway {

/// A force at a body's origin and the moment about it.
struct Wrench {
  Vec2 force;
  double moment;
};

template <class Size>
struct Dynamics {
  static constexpr int n_bodies = at_least_one(Size::bodies), n_coordinates = at_least_one(Size::coordinates);
  Vec2 own_moment[n_bodies];  ///< mass times (com - origin) of the body alone, world's frame, kg m
  Vec2 moment[n_bodies];      ///< the same of the body and all it carries
  double inertia[n_bodies];   ///< of the body and all it carries, about its origin, kg m^2
  Wrench applied[n_bodies];   ///< springs, loads and steady friction (friction.hpp)
  Wrench known[n_bodies];     ///< applied, gravity and -(inertia of the known accelerations); with all carried
  double h[n_coordinates];    ///< known force on each coordinate, driven ones too
  double M[n_coordinates][n_coordinates];  ///< free coordinates, lower triangle; then G
  double diagonal[n_coordinates];          ///< M's, kept for the self-check
  double inverse[n_coordinates];           ///< 1 / G_ff
  double applied_power, damper_power;      ///< W
};

/// Springs and loads as wrenches on the bodies; their power. Linear in the items.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void apply_forces(const Source& source, const Kinematics<Size>& k, const Inputs<Size>& inputs,
                                  double tau, Dynamics<Size>& d) noexcept {
  const auto& scene = source.scene;
  const auto push = [&](int i, Vec2 rho, Vec2 force) SLIDEWAY_FOLD {
    d.applied[i].force = d.applied[i].force + force;
    d.applied[i].moment += cross(rho, force);
  };
  d.applied_power = d.damper_power = 0;
  if (scene.springs + scene.loads + source.tables.steady > 0) {
    for_each<Source, Size::bodies>(scene.bodies, [&](int i) SLIDEWAY_FOLD { d.applied[i] = {}; });
  }
  for_each<Source, Size::springs>(scene.springs, [&](int s) SLIDEWAY_FOLD {
    const Spring& spring = scene.spring[s];
    const Point a = point_at(source, k, spring.a, spring.a_at, {true, true});
    const Point b = point_at(source, k, spring.b, spring.b_at, {true, true});
    const Vec2 gap = a.place - b.place;
    const double length = std::sqrt(dot(gap, gap));
    // A spring of no length has no direction; its force is taken as zero there.
    const Vec2 along = length > 0 ? (1 / length) * gap : Vec2{};
    const double rate = dot(along, a.velocity - b.velocity);
    const Vec2 force = (-(spring.stiffness * (length - spring.length) + spring.damping * rate)) * along;
    push(spring.a, a.rho, force);
    if (spring.b != ground) push(spring.b, b.rho, {-force.x, -force.y});
    d.damper_power += spring.damping * rate * rate;
  });
  for_each<Source, Size::loads>(scene.loads, [&](int l) SLIDEWAY_FOLD {
    const Load& load = scene.load[l];
    const double scale = load.input == none ? 1 : value_at(inputs.input[load.input], tau).value;
    const Point p = point_at(source, k, load.body, load.at, {true, true});
    const Vec2 force = scale * load.force;
    const double torque = scale * load.torque;
    push(load.body, p.rho, force);
    d.applied[load.body].moment += torque;
    d.applied_power += dot(force, p.velocity) + torque * k.rate[load.body];
  });
}

/// First moments and inertias of each body with all it carries, and the known wrenches: applied forces, gravity, and
/// the inertia of the known accelerations, by Newton and Euler about each body's origin.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void gather(const Source& source, const Kinematics<Size>& k, Dynamics<Size>& d) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  for_each<Source, Size::bodies>(scene.bodies, [&](int i) SLIDEWAY_FOLD {
    const Body& body = scene.body[i];
    const bool off = table.com[i].any();
    const Vec2 moment = body.mass * rotate(k.turn[i], body.com, table.com[i]);
    const Vec2 pull = table.moving[i] ? scene.gravity - k.known[i] : scene.gravity;
    Wrench known = table.applied[i] ? d.applied[i] : Wrench{};
    Sum force;
    if (table.applied[i]) force.add(known.force);
    if (body.mass > 0) force.add(body.mass * pull);
    if (off && table.turning[i]) force.add((k.rate[i] * k.rate[i]) * moment);
    if (off && table.known_turning[i]) force.add(-k.known_alpha[i] * perp(moment));
    double about = known.moment;
    if (off) about = table.applied[i] ? about + cross(moment, pull) : cross(moment, pull);
    if (table.known_turning[i]) about -= table.origin_inertia[i] * k.known_alpha[i];
    d.own_moment[i] = d.moment[i] = moment;
    d.inertia[i] = table.origin_inertia[i];
    d.known[i] = {force.value, about};
  });
  for_each_down<Source, Size::bodies>(scene.bodies, [&](int i) SLIDEWAY_FOLD {
    const Body& body = scene.body[i];
    const int p = body.parent;
    if (p == ground) return;
    const Vec2 arm = k.arm[i];
    const bool slides = body.joint == Joint::prismatic || body.joint == Joint::planar;
    const double arm_squared = slides ? dot(arm, arm) : table.arm_squared[i];
    if (table.off_centre[i]) d.inertia[p] += 2 * dot(arm, d.moment[i]);
    d.inertia[p] += d.inertia[i] + table.carried_mass[i] * arm_squared;
    if (table.off_centre[i]) d.moment[p] = d.moment[p] + d.moment[i];
    if (slides || table.at[i].any()) d.moment[p] = d.moment[p] + table.carried_mass[i] * arm;
    d.known[p].force = d.known[p].force + d.known[i].force;
    d.known[p].moment += d.known[i].moment + cross(arm, d.known[i].force);
  });
}

/// The force that a wrench on body i gives to one of its coordinates.
SLIDEWAY_INLINE constexpr double along(Motion motion, Rotation frame, const Wrench& w) noexcept {
  return motion == Motion::turn ? w.moment : dot(axis(frame, motion), w.force);
}

/// Entry of M for a coordinate of body i and one of body b on its path to the ground (b = i included), from the mass,
/// first moment and inertia of i and all it carries (composite bodies; Featherstone 2008, ch. 6).
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double mass_entry(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d, int i,
                                  Motion motion, int b, Motion up) noexcept {
  const auto& table = source.tables;
  const double mass = table.carried_mass[i];
  const bool off = table.off_centre[i];
  if (motion == Motion::turn && up == Motion::turn) {
    return off && b != i ? d.inertia[i] + dot(k.origin[i] - k.origin[b], d.moment[i]) : d.inertia[i];
  }
  if (motion == Motion::turn) return off ? dot(perp(d.moment[i]), axis(k.frame[b], up)) : 0;
  const Vec2 slide = axis(k.frame[i], motion);
  if (up != Motion::turn) return b == i ? (motion == up ? mass : 0) : mass * dot(slide, axis(k.frame[b], up));
  const Vec2 lever = mass * (k.origin[i] - k.origin[b]);
  return dot(slide, perp(off ? d.moment[i] + lever : lever));
}

/// h, M and M = G' G. False when M is not positive definite to rounding: a free coordinate moves no mass.
///
/// G is the Cholesky factor taken from the leaves, which fills nothing beyond the tree. Cost: sum of squared depths.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool factor_mass(const Source& source, const Kinematics<Size>& k, const double* q, const double* v,
                                 Dynamics<Size>& d) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  for_each<Source, Size::coordinates>(table.coordinates, [&](int j) SLIDEWAY_FOLD {
    const int i = table.body_of[j], f = table.free_of[j];
    d.h[j] = along(table.motion[j], k.frame[i], d.known[i]);
    if (f == none) return;
    d.M[f][f] = d.diagonal[f] = mass_entry(source, k, d, i, table.motion[j], i, table.motion[j]);
    for_each<Source, Size::coordinates>(table.ups[f], [&](int e) SLIDEWAY_FOLD {
      const int g = table.up[f][e], l = table.free_coordinate[g];
      d.M[f][g] = mass_entry(source, k, d, i, table.motion[j], table.body_of[l], table.motion[l]);
    });
  });
  for_each<Source, Size::joint_springs>(scene.joint_springs, [&](int s) SLIDEWAY_FOLD {
    const JointSpring& spring = scene.joint_spring[s];
    const int j = table.first[spring.body];
    d.h[j] -= spring.stiffness * (q[j] - spring.rest) + spring.damping * v[j];
    d.damper_power += spring.damping * v[j] * v[j];
  });
  // What is left of a pivot after n subtractions of its own size is rounding below n eps of it, of entries that carry
  // some tens of roundings each themselves.
  const double rounding = 64 * table.free * detail::epsilon;
  bool definite = true;
  for_each_down<Source, Size::coordinates>(table.free, [&](int f) SLIDEWAY_FOLD {
    definite &= d.M[f][f] > rounding * d.diagonal[f];
    d.M[f][f] = std::sqrt(d.M[f][f]);
    d.inverse[f] = detail::quotient(1, d.M[f][f]);
    for_each<Source, Size::coordinates>(table.ups[f], [&](int e) SLIDEWAY_FOLD {
      const int g = table.up[f][e];
      d.M[f][g] *= d.inverse[f];
      for_each<Source, Size::coordinates>(e + 1, [&](int c) SLIDEWAY_FOLD {
        const int l = table.up[f][c];
        d.M[g][l] -= d.M[f][g] * d.M[f][l];
      });
    });
  });
  return definite;
}

/// x := G^-T x over the free coordinates in `list` (ascending; closed under going up), for each row x given. Cost: sum
/// of depths, a row.
template <class Source, class... Row, class Size = typename Source::Size>
SLIDEWAY_INLINE void to_metric(const Source& source, const Dynamics<Size>& d, const Index* list, int count,
                               Row*... row) noexcept {
  const auto& table = source.tables;
  for_each_down<Source, Size::coordinates>(count, [&](int c) SLIDEWAY_FOLD {
    const int f = list[c];
    ((row[f] *= d.inverse[f]), ...);
    for_each<Source, Size::coordinates>(table.ups[f], [&](int e) SLIDEWAY_FOLD {
      const int g = table.up[f][e];
      ((row[g] -= d.M[f][g] * row[f]), ...);
    });
  });
}

/// x := G^-1 x over all free coordinates.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void from_metric(const Source& source, const Dynamics<Size>& d, double* x) noexcept {
  const auto& table = source.tables;
  for_each<Source, Size::coordinates>(table.free, [&](int f) SLIDEWAY_FOLD {
    for_each<Source, Size::coordinates>(table.ups[f], [&](int e) SLIDEWAY_FOLD {
      const int g = table.up[f][e];
      x[f] -= d.M[f][g] * x[g];
    });
    x[f] *= d.inverse[f];
  });
}

}  // namespace slideway
