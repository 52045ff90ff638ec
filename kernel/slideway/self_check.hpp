// What follows from the contact forces, and the check that it satisfies the equations.
//
// The check does not reuse M, its factor or the rows: it adds up forces and moments body by body (Newton and Euler) and
// measures the accelerations of the contact points. What the driven coordinates then lack is the drives' force.
#pragma once

#include <slideway/rest.hpp>

namespace slideway {

template <class Size>
struct Work {
  Kinematics<Size> kinematics;
  Dynamics<Size> dynamics;
  Friction<Size> friction;
  double prescribed[at_least_one(Size::coordinates)];
  double u[at_least_one(Size::coordinates)];  ///< G q''
  double scale;  ///< sum of the lengths of all terms of u: the rounding scale of its entries
  double pi[Friction<Size>::n_ideal];
};

/// What a guide does to its slider, gathered at the first contact: lambda_0 + lambda_1 along n, friction along t, and
/// the couple along lambda_1 - across friction_1.
struct GuideForce {
  double normal, friction, couple;
};

template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE GuideForce guide_force(const Source& source, const Friction<Size>& fr, const Reaction<Size>& r,
                                       int g) noexcept {
  const int c = source.tables.first_contact[g];
  const bool two = source.scene.guide[g].contacts == 2;
  if (!source.tables.is_rough[g]) {
    return {two ? r.lambda[c] + r.lambda[c + 1] : r.lambda[c], 0, two ? fr.sliding[g].along * r.lambda[c + 1] : 0};
  }
  const double size = fr.face[c] * r.lambda[c];
  if (!two) return {r.lambda[c], fr.sigma[g] * size + fr.stiction[g], 0};
  const double size_1 = fr.face[c + 1] * r.lambda[c + 1];
  return {r.lambda[c] + r.lambda[c + 1], fr.sigma[g] * (size + size_1) + fr.stiction[g],
          fr.sliding[g].along * r.lambda[c + 1] - fr.sliding[g].across * (fr.sigma[g] * size_1)};
}

/// u, its rounding scale and pi from the contact forces.  [friction.hpp]
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void resolve(const Source& source, const Reaction<Size>& r, Work<Size>& w) noexcept {
  const auto& table = source.tables;
  const Friction<Size>& fr = w.friction;
  w.scale = 0;
  for_each<Source, Size::coordinates>(table.free, [&](int f) SLIDEWAY_FOLD {
    w.u[f] = fr.free_motion[f];
    w.scale += std::fabs(fr.free_motion[f]);
  });
  for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
    if (!table.is_rough[g]) return;
    const Link<Size>& link = table.guide[g];
    const GuideForce force = guide_force(source, fr, r, g);
    const bool two = source.scene.guide[g].contacts == 2;
    for_each<Source, Size::coordinates>(link.fills, [&](int e) SLIDEWAY_FOLD {
      const int f = link.fill[e];
      const double tangential = fr.T[g][f] * force.friction;
      w.u[f] += fr.N[g][f] * force.normal + tangential;
      if (two) w.u[f] += fr.E[g][f] * force.couple;
      w.scale += std::fabs(tangential);
    });
    for_each<Source, 2>(source.scene.guide[g].contacts, [&](int i) SLIDEWAY_FOLD {
      const int c = table.first_contact[g] + i;
      w.scale += fr.norm[c] * std::fabs(r.lambda[c]);
    });
  });
  if (table.ideal == 0) return;
  constexpr int capacity = Friction<Size>::ideal;
  for_each<Source, capacity>(table.ideal, [&](int i) SLIDEWAY_FOLD {
    w.pi[i] = fr.e[i] - inner(source, table.part_of_ideal[i], fr.Q[i], w.u);
  });
  for_each<Source, capacity>(
      table.ideal, [&](int i) SLIDEWAY_FOLD { add_scaled(source, table.part_of_ideal[i], w.pi[i], fr.Q[i], w.u); });
  for_each_down<Source, capacity>(table.ideal, [&](int i) SLIDEWAY_FOLD {
    w.pi[i] /= fr.R[i][i];
    each_ideal_before(source, i, [&](int m) SLIDEWAY_FOLD { w.pi[m] -= fr.R[i][m] * w.pi[i]; });
    w.scale += fr.ideal_norm[i] * std::fabs(w.pi[i]);
  });
}

/// Is anything known of u? Its terms, of which contact forces are parts, carry roundings of eps times their lengths'
/// sum. Where forces cancel so far that not 20 bits (1e-6) are left beside the motion with and without them, the
/// constraints have lost rank and the forces are rounding errors over rounding errors.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool resolved(const Source& source, const Work<Size>& w) noexcept {
  double left = 0;
  for_each<Source, Size::coordinates>(source.tables.free, [&](int f) SLIDEWAY_FOLD {
    left += std::fabs(w.u[f]) + std::fabs(w.friction.free_motion[f]);
  });
  return !(w.scale * (detail::epsilon * 0x1p20) > left);  // what is not finite is for the self-check to refuse
}

/// Friction of all guides into the reaction; false when that of a guide that slips does not oppose the slip. A guide
/// without a mode is at rest.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool rub(const Source& source, const Friction<Size>& fr, const bool* rests,
                         Reaction<Size>& r) noexcept {
  bool opposes = true;
  for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
    r.friction[g] = guide_force(source, fr, r, g).friction;
    if (source.tables.is_steady[g]) r.friction[g] += fr.steady[g];
    opposes = opposes && (r.friction[g] * r.slip[g] <= 0 || rests[g]);
  });
  return opposes;
}

/// A body's share of the check: what the free accelerations and the constraint forces give it.
template <class Size>
struct Balance {
  static constexpr int n_bodies = at_least_one(Size::bodies);
  double alpha[n_bodies];  ///< by the free coordinates
  Vec2 a[n_bodies];
  Wrench wrench[n_bodies];
};

/// Accelerations that the free q'' add to each body, and the inertia forces against them. Linear in the bodies.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void add_free_motion(const Source& source, const Work<Size>& w, const double* qdd,
                                     Balance<Size>& balance) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  const Kinematics<Size>& k = w.kinematics;
  for_each<Source, Size::bodies>(scene.bodies, [&](int i) SLIDEWAY_FOLD {
    const Body& body = scene.body[i];
    const int p = body.parent, j = table.first[i];
    const bool planar = body.joint == Joint::planar, slides = planar || body.joint == Joint::prismatic;
    const bool turns = planar || body.joint == Joint::revolute;
    const int turn_j = planar ? j + 2 : j;
    const bool carried_round = p != ground && table.freely_turning[p];
    const bool free_turn = turns && table.free_of[turn_j] != none;
    balance.alpha[i] = !free_turn      ? (carried_round ? balance.alpha[p] : 0)
                       : carried_round ? balance.alpha[p] + qdd[turn_j]
                                       : qdd[turn_j];
    Sum a;
    if (p != ground && table.freely_moving[p]) a.add(balance.a[p]);
    if (carried_round && (slides || table.at[i].any())) a.add(balance.alpha[p] * perp(k.arm[i]));
    if (slides && table.free_of[j] != none) a.add(qdd[j] * axis(k.frame[i], Motion::slide_x));
    if (planar && table.free_of[j + 1] != none) a.add(qdd[j + 1] * axis(k.frame[i], Motion::slide_y));
    balance.a[i] = a.value;

    const bool off = table.com[i].any();
    Sum force;
    double moment = 0;
    if (table.freely_turning[i]) {
      moment = -table.origin_inertia[i] * balance.alpha[i];
      if (off) force.add(-balance.alpha[i] * perp(w.dynamics.own_moment[i]));
    }
    if (table.freely_moving[i]) {
      force.add(-body.mass * balance.a[i]);
      if (off) moment -= cross(w.dynamics.own_moment[i], balance.a[i]);
    }
    balance.wrench[i] = {force.value, moment};
  });
}

/// Acceleration that the free q'' give to the point of body i at rho.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE Vec2 free_acceleration(const Source& source, const Balance<Size>& balance, int i, Vec2 rho) noexcept {
  if (i == ground) return {};
  Sum a;
  if (source.tables.freely_moving[i]) a.add(balance.a[i]);
  if (source.tables.freely_turning[i]) a.add(balance.alpha[i] * perp(rho));
  return a.value;
}

template <class Size>
SLIDEWAY_INLINE void push(Balance<Size>& balance, int i, Vec2 rho, Vec2 force, double couple,
                          bool has_couple) noexcept {
  if (i == ground) return;
  balance.wrench[i].force = balance.wrench[i].force + force;
  balance.wrench[i].moment += has_couple ? cross(rho, force) + couple : cross(rho, force);
}

/// Smallest normal number: keeps the quotient of a vanishing residual by a vanishing scale at zero.
inline constexpr double tiny = 0x1p-1022;

/// Guide g in the self-check: its forces onto the slider and the rail, and the residual of its rows over their rounding
/// scale.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double check_guide(const Source& source, const Friction<Size>& fr, double scale, int g,
                                   const Reaction<Size>& r, Balance<Size>& balance) noexcept {
  const auto& table = source.tables;
  const Guide& guide = source.scene.guide[g];
  const Sliding& s = fr.sliding[g];
  const int c = table.first_contact[g], rail = guide.rail, slider = guide.slider;
  const bool two = guide.contacts == 2, rough = table.is_rough[g];
  const GuideForce of_guide = guide_force(source, fr, r, g);
  const Vec2 normal = of_guide.normal * s.n, force = rough ? normal + of_guide.friction * s.t : normal;
  push(balance, slider, s.on_slider, force, of_guide.couple, two);
  push(balance, rail, s.on_rail, {-force.x, -force.y}, -of_guide.couple, two);

  Vec2 relative = free_acceleration(source, balance, slider, s.on_slider);
  if (rail != ground) relative = relative - free_acceleration(source, balance, rail, s.on_rail);
  const double accelerated = dot(s.n, relative);
  const double* norm = rough ? fr.norm + c : fr.ideal_norm + table.row_of[c];
  double residual = std::fabs(accelerated - fr.target[c]) / (std::fabs(fr.target[c]) + norm[0] * scale + tiny);
  if (two) {
    const double turning = rail == ground ? balance.alpha[slider] : balance.alpha[slider] - balance.alpha[rail];
    residual += std::fabs(accelerated + s.along * turning - fr.target[c + 1]) /
                (std::fabs(fr.target[c + 1]) + norm[1] * scale + tiny);
  }
  return residual;
}

/// What crosses the mechanism's border at the rates of the kinematics, W. Linear in the items.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void measure_power(const Source& source, const double* v, const Work<Size>& w,
                                   Reaction<Size>& r) noexcept {
  const auto& table = source.tables;
  const Friction<Size>& fr = w.friction;
  r.power = {w.dynamics.applied_power, w.dynamics.damper_power, 0};
  for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
    const Sliding& s = fr.sliding[g];
    const int c = table.first_contact[g];
    if (fr.held[g]) {  // its speed is drift
      r.power.constraint_work += r.friction[g] * s.slip[0];
    } else {
      r.power.dissipated -= r.friction[g] * s.slip[0];
    }
    r.power.constraint_work += r.lambda[c] * s.Phi_rate[0];
    if (source.scene.guide[g].contacts == 1) return;
    if (table.is_rough[g]) {  // what this contact slips beyond the other is drift too
      r.power.constraint_work += fr.sigma[g] * (fr.face[c + 1] * r.lambda[c + 1]) * (s.slip[1] - s.slip[0]);
    }
    r.power.constraint_work += r.lambda[c + 1] * s.Phi_rate[1];
  });
  for_each<Source, Size::pins>(
      source.scene.pins, [&](int p) SLIDEWAY_FOLD { r.power.constraint_work += dot(r.pin[p], fr.meeting[p].rate); });
  for_each<Source, Size::drives>(source.scene.drives, [&](int d) SLIDEWAY_FOLD {
    r.power.work += r.drive[d] * v[table.first[source.scene.drive[d].body] + source.scene.drive[d].axis];
  });
}

/// The self-check: sum over all equations of |residual| / (rounding scale). Fills in the drives' forces.
///
/// Rounding scales, from u = G q'' (friction.hpp): u is a sum of terms with `scale` the sum of their lengths, so it
/// carries a few eps of that; G maps an error du to one of at most sqrt(M_jj) |du| in row j of the equations of motion
/// (Cauchy and Schwarz with M = G'G), and a row N~ to one of at most |N~| |du|. So rows j are measured in
/// sqrt(M_jj) scale, rows of contacts and pins in |c| + |N~| scale. A sum, not a maximum: it passes NaN on.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double check(const Source& source, const Work<Size>& w, Reaction<Size>& r) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  const Kinematics<Size>& k = w.kinematics;
  const Friction<Size>& fr = w.friction;
  Balance<Size> balance;
  add_free_motion(source, w, r.acceleration, balance);
  const double scale = w.scale;
  double residual = 0;

  for_each<Source, Size::guides>(
      scene.guides, [&](int g) SLIDEWAY_FOLD { residual += check_guide(source, fr, scale, g, r, balance); });
  for_each<Source, Size::pins>(scene.pins, [&](int p) SLIDEWAY_FOLD {
    const Pin& pin = scene.pin[p];
    const Meeting& at = fr.meeting[p];
    push(balance, pin.a, at.on_a, r.pin[p], 0, false);
    push(balance, pin.b, at.on_b, {-r.pin[p].x, -r.pin[p].y}, 0, false);
    const Vec2 left = free_acceleration(source, balance, pin.a, at.on_a) -
                      free_acceleration(source, balance, pin.b, at.on_b) -
                      Vec2{fr.ideal_target[2 * p], fr.ideal_target[2 * p + 1]};
    residual += std::fabs(left.x) / (std::fabs(fr.ideal_target[2 * p]) + fr.ideal_norm[2 * p] * scale + tiny);
    residual += std::fabs(left.y) / (std::fabs(fr.ideal_target[2 * p + 1]) + fr.ideal_norm[2 * p + 1] * scale + tiny);
  });

  for_each_down<Source, Size::bodies>(scene.bodies, [&](int i) SLIDEWAY_FOLD {
    const int p = scene.body[i].parent;
    if (p == ground) return;
    balance.wrench[p].force = balance.wrench[p].force + balance.wrench[i].force;
    balance.wrench[p].moment += balance.wrench[i].moment + cross(k.arm[i], balance.wrench[i].force);
  });
  const double inverse_scale = 1 / (scale + tiny);
  for_each<Source, Size::coordinates>(table.coordinates, [&](int j) SLIDEWAY_FOLD {
    const int i = table.body_of[j];
    const double left = w.dynamics.h[j] + along(table.motion[j], k.frame[i], balance.wrench[i]);
    if (table.free_of[j] != none) {
      residual += std::fabs(left) * inverse_scale / std::sqrt(w.dynamics.diagonal[table.free_of[j]]);
    } else {
      r.drive[table.drive_of[j]] = -left;
    }
  });
  return residual;
}

/// Largest sum of the self-check. Each of at most `items` equations takes one rounding (a product or a sum, half an eps
/// each) for each of at most `items` terms on the way to u, as many through G and back, as many in the rows, and as
/// many in the check itself: four halves of an eps, items squared times. Dimensionless.
template <class Source>
constexpr double residual_bound(const Source& source) noexcept {
  const auto& table = source.tables;
  const double items = table.coordinates + table.contacts + table.ideal + source.scene.bodies;
  return 2 * detail::epsilon * items * items;
}

}  // namespace slideway
