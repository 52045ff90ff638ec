// Positions and velocities moved onto the constraints, by the least change in the mass metric.
#pragma once

#include <slideway/acceleration.hpp>

namespace slideway {

/// As many independent constraints as coordinates: the drives decide the whole motion.
template <class Source>
constexpr bool fully_driven(const Source& source) noexcept {
  return source.tables.free == source.tables.contacts + 2 * source.scene.pins;
}

namespace detail {

/// All constraints as rows of Q in the mass metric; errors: Phi or Phi'. Returns the largest |error|.
template <class Source, class Size = typename Source::Size>
double constraint_rows(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d, bool of_rates,
                       Friction<Size>& fr, double& reach) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  double worst = 0;
  reach = table.length;
  const auto set = [&](int m, const Link<Size>& link, Vec2 place, Vec2 direction, double error) {
    for_each<Source, Size::coordinates>(table.free, [&](int f) SLIDEWAY_FOLD { fr.Q[m][f] = 0; });
    set_row(source, k, link, place, direction, fr.Q[m]);
    to_metric(source, d, table.every, table.free, fr.Q[m]);
    fr.e[m] = -error;
    worst = worst >= std::fabs(error) || !(worst == worst) ? worst : std::fabs(error);  // NaN stays
    reach = larger(reach, larger(std::fabs(place.x), std::fabs(place.y)));
  };
  for_each<Source, Size::pins>(scene.pins, [&](int p) {
    Meeting at;
    meeting(source, k, p, at);
    const Vec2 error = of_rates ? at.rate : at.Phi;
    set(2 * p, table.pin[p], at.place, {1, 0}, error.x);
    set(2 * p + 1, table.pin[p], at.place, {0, 1}, error.y);
  });
  for_each<Source, Size::guides>(scene.guides, [&](int g) {
    Sliding& s = fr.sliding[g];
    sliding(source, k, g, s);
    for (int i = 0; i < scene.guide[g].contacts; ++i) {
      const Vec2 place = i == 0 ? s.place : s.place + s.along * s.t + s.across * s.n;
      set(2 * scene.pins + table.first_contact[g] + i, table.guide[g], place, s.n, of_rates ? s.Phi_rate[i] : s.Phi[i]);
    }
  });
  return worst;
}

/// x (by coordinate) += the least change in the mass metric that removes the errors to first order.
template <class Source, class Size = typename Source::Size>
bool correct(const Source& source, const Dynamics<Size>& d, Friction<Size>& fr, double* x) noexcept {
  const auto& table = source.tables;
  const int rows = table.contacts + 2 * source.scene.pins;
  double change[at_least_one(Size::coordinates)] = {};
  bool independent = true;
  for_each<Source, 2 * Size::pins + Size::contacts>(rows, [&](int m) {
    independent = independent && orthonormalise(source, fr, m);
    if (!independent) return;
    for (int i = 0; i < m; ++i) fr.e[m] -= fr.R[m][i] * fr.e[i];
    fr.e[m] /= fr.R[m][m];
    add_scaled(source, fr.e[m], fr.Q[m], change);
  });
  if (!independent) return false;
  from_metric(source, d, change);
  for (int f = 0; f < table.free; ++f) x[table.free_coordinate[f]] += change[f];
  return true;
}

}  // namespace detail

/// Newton steps a projection may take: from a tenth of the scene's length four do, from far away none will.
inline constexpr int projection_limit = 16;

/// Moves q, v onto the constraints at time t: driven coordinates onto their laws, the free ones by the least change in
/// the mass metric. ok, singular_constraints (redundant in this pose) or no_convergence.
///
/// Done when every |Phi| is below 16 eps (bodies + 1) times the largest distance: the rounding of a point's place,
/// a few eps for each body on its path. At most `projection_limit` Newton steps, each O(constraints^2 coordinates).
template <class Source, class Size = typename Source::Size>
Status project(const Source& source, double t, double tau, const Inputs<Size>& inputs, double* q, double* v) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  Kinematics<Size> k;
  Dynamics<Size> d;
  Friction<Size> fr;
  const double at_rest[at_least_one(Size::coordinates)] = {};
  for (int i = 0; i < scene.drives; ++i) {
    const LawValue law = law_at(scene.drive[i], t, inputs.input, tau);
    const int j = table.first[scene.drive[i].body] + scene.drive[i].axis;
    q[j] = law.value;
    v[j] = law.rate;
  }
  for (int step = 0; step <= projection_limit; ++step) {
    kinematics(source, q, v, at_rest, k);
    apply_forces(source, k, inputs, tau, d);
    gather(source, k, d);
    if (!factor_mass(source, k, q, v, d)) return Status::singular_constraints;
    double reach = 0;
    const double worst = detail::constraint_rows(source, k, d, false, fr, reach);
    if (!(worst - worst == 0)) return Status::no_convergence;
    if (worst <= 16 * detail::epsilon * (scene.bodies + 1) * reach) {
      detail::constraint_rows(source, k, d, true, fr, reach);
      return detail::correct(source, d, fr, v) ? Status::ok : Status::singular_constraints;
    }
    if (!detail::correct(source, d, fr, q)) return Status::singular_constraints;
  }
  return Status::no_convergence;
}

}  // namespace slideway
