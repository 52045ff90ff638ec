// From the equations of motion to the contact forces' problem: constraint rows in the mass metric, pins and
// frictionless contacts eliminated, and the HLCP  S lambda + S* |lambda| = b  of the rough contacts (WWZ14 (13)-(19)).
//
// With u = G q'' (dynamics.hpp), rows N~ = N G^-1 and so on, the dynamics read
//   u = h~ + N~' lambda + T~' F + P~' pi,   P~ u = c_P (ideal rows),   N~ u = c_N,   F = sigma |lambda| + F_0,
// sigma = -mu sgn(slip) where the guide slips. Viscous and preload friction of a guide that slips are in h; F_0 is
// friction at rest, an unknown of rest.hpp. Gram and Schmidt give P~ = R Q with orthonormal rows Q; with N^ = N~ (I -
// Q'Q) and u0 = h~ + Q'(e - Q h~), R e = c_P, the unknowns pi drop out:
//   S = N^ N^',  S*_ij = sigma_j N^_i . T~_j,  b = c_N - N~ u0.
// The rows of a guide's two contacts differ by the slider's turning against the rail, E: three rows serve for four.
// No inverse and no Schur complement is formed, so a mass ratio costs no digits beyond those of the rows themselves.
#pragma once

#include <slideway/dynamics.hpp>
#include <slideway/hlcp.hpp>
#include <utility>

namespace slideway {

template <class Size>
struct Friction {
  static constexpr int n_free = at_least_one(Size::coordinates), n_contacts = at_least_one(Size::contacts),
                       ideal = 2 * Size::pins + Size::contacts, n_ideal = at_least_one(ideal);
  static constexpr int n_guides = at_least_one(Size::guides);
  Sliding sliding[n_guides];
  double target[n_contacts];         ///< c: N q'' = c
  double N[n_guides][n_free];        ///< N~ of a rough guide's first contact; of its second N~ + along E~
  double T[n_guides][n_free];        ///< T~ of the first; of the second T~ - across E~
  double E[n_guides][n_free];        ///< the slider's turning against the rail
  double N_clear[n_guides][n_free];  ///< N^ and E^: orthogonal to the ideal rows; used where their part has any
  double E_clear[n_guides][n_free];
  double right[n_contacts];    ///< b of each rough contact
  double norm[n_contacts];     ///< |N~| of each rough contact
  double sigma[n_guides];      ///< friction per |lambda|, along the guide; 0 at rest
  double stiction[n_guides];   ///< F_0, at the first contact, N
  double steady[n_guides];     ///< viscous and preload friction while slipping, at the first contact, N; in h
  bool held[n_guides];         ///< at rest, or leaving it at this instant: its speed is drift
  double face[n_contacts];     ///< +1, -1: the face that carries, so that |lambda| = face lambda
  double free_motion[n_free];  ///< h~
  double u0[n_free];
  double Q[n_ideal][n_free], R[n_ideal][n_ideal], e[n_ideal];
  double ideal_norm[n_ideal];  ///< |P~_i|
  Meeting meeting[at_least_one(Size::pins)];
  double ideal_target[n_ideal];  ///< c_P of the pins
};

/// Rough contacts and rough guides of the largest part; of a scene that the compiler does not know, of all there is
/// room for.
template <class Source, bool known = Source::folds>
inline constexpr int most_rows = Source::Size::contacts;
template <class Source>
inline constexpr int most_rows<Source, true> = Source::tables.most_rows;
template <class Source, bool known = Source::folds>
inline constexpr int most_guides = Source::Size::guides;
template <class Source>
inline constexpr int most_guides<Source, true> = Source::tables.most_guides;

/// The HLCP of a part's rough contacts.
template <class Source>
using Problem = Hlcp<at_least_one(most_rows<Source>)>;

/// The relative Jacobian row of a link along `direction` at `place`: the free coordinates among its columns.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void set_row(const Source& source, const Kinematics<Size>& k, const Link<Size>& link, Vec2 place,
                             Vec2 direction, double* x) noexcept {
  const auto& table = source.tables;
  for_each<Source, Size::coordinates>(link.columns, [&](int c) SLIDEWAY_FOLD {
    const int j = link.column[c], f = table.free_of[j], i = table.body_of[j];
    if (f != none) x[f] = dot(direction, column(table.motion[j], k.frame[i], place - k.origin[i], link.side[c]));
  });
}

/// x = 0 on what a link's row reaches.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void clear(const Link<Size>& link, double* x) noexcept {
  for_each<Source, Size::coordinates>(link.fills, [&](int c) SLIDEWAY_FOLD { x[link.fill[c]] = 0; });
}

/// The row of a link in the mass metric.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void metric_row(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d,
                                const Link<Size>& link, Vec2 place, Vec2 direction, double* x) noexcept {
  clear<Source>(link, x);
  set_row(source, k, link, place, direction, x);
  to_metric(source, d, link.fill, link.fills, x);
}

/// f(free coordinate) for each of a part.
template <class Source, class F, class Size = typename Source::Size>
SLIDEWAY_INLINE void each_in_part(const Source& source, int part, F&& f) noexcept {
  const auto& table = source.tables;
  const int first = table.first_in_part[part];
  for_each<Source, Size::coordinates>(table.first_in_part[part + 1] - first,
                                      [&](int i) SLIDEWAY_FOLD { f(table.in_part[first + i]); });
}

/// f(rough guide) for each of a part.
template <class Source, class F>
SLIDEWAY_INLINE void each_guide_in_part(const Source& source, int part, F&& f) noexcept {
  const auto& table = source.tables;
  const int first = table.first_guide[part];
  for_each<Source, most_guides<Source>>(table.first_guide[part + 1] - first,
                                        [&](int i) SLIDEWAY_FOLD { f(table.rough_guide[first + i]); });
}

/// How many rough contacts a part has.
template <class Size>
constexpr int row_count(const Tables<Size>& table, int part) noexcept {
  return table.first_row[part + 1] - table.first_row[part];
}

/// f(row, contact) for each rough contact of a part.
template <class Source, class F>
SLIDEWAY_INLINE void each_row_in_part(const Source& source, int part, F&& f) noexcept {
  const auto& table = source.tables;
  const int first = table.first_row[part];
  for_each<Source, most_rows<Source>>(row_count(table, part),
                                      [&](int m) SLIDEWAY_FOLD { f(m, table.rough_contact[first + m]); });
}

/// sum x_f y_f over the free coordinates of a part.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double inner(const Source& source, int part, const double* x, const double* y) noexcept {
  double sum = 0;
  each_in_part(source, part, [&](int f) SLIDEWAY_FOLD { sum += x[f] * y[f]; });
  return sum;
}

/// y += s x over the free coordinates of a part.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void add_scaled(const Source& source, int part, double s, const double* x, double* y) noexcept {
  each_in_part(source, part, [&](int f) SLIDEWAY_FOLD { y[f] += s * x[f]; });
}

/// A row whose distance from the span of the earlier ones is below this part of its length is redundant: the distance
/// carries an error of a few eps per coordinate and row, so that at this bound no digit of it is left. Dimensionless.
template <class Source>
constexpr double rank_bound(const Source& source) noexcept {
  return 8 * detail::epsilon * (source.tables.free + source.tables.ideal);
}

/// f(i) for the ideal rows i < m of row m's part.
template <class Source, class F>
SLIDEWAY_INLINE void each_ideal_before(const Source& source, int m, F&& f) noexcept {
  for_each<Source, Friction<typename Source::Size>::ideal>(m, [&](int i) SLIDEWAY_FOLD {
    if (source.tables.part_of_ideal[i] == source.tables.part_of_ideal[m]) f(i);
  });
}

/// Takes row m of Q (as P~_m) into the orthonormal set of the rows of its part before it: twice, which is enough
/// (Giraud and others 2005). False when it is redundant. Cost: 4 m n.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool orthonormalise(const Source& source, Friction<Size>& fr, int m) noexcept {
  constexpr int capacity = Friction<Size>::ideal;
  SLIDEWAY_ASSUME(m >= 0 && m < capacity);
  double* row = fr.Q[m];
  const int part = source.tables.part_of_ideal[m];
  fr.ideal_norm[m] = std::sqrt(inner(source, part, row, row));
  each_ideal_before(source, m, [&](int i) SLIDEWAY_FOLD { fr.R[m][i] = 0; });
  for (int pass = 0; pass < 2; ++pass) {
    each_ideal_before(source, m, [&](int i) SLIDEWAY_FOLD {
      const double shared = inner(source, part, fr.Q[i], row);
      fr.R[m][i] += shared;
      add_scaled(source, part, -shared, fr.Q[i], row);
    });
  }
  const double rest = std::sqrt(inner(source, part, row, row));
  if (!(rest > rank_bound(source) * fr.ideal_norm[m])) return false;
  fr.R[m][m] = rest;
  each_in_part(source, part, [&](int f) SLIDEWAY_FOLD { row[f] *= 1 / rest; });
  return true;
}

/// Pins and frictionless contacts: Q, R, e and u0. False when they are redundant.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool eliminate_ideal(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d,
                                     Gains gains, Friction<Size>& fr, Reaction<Size>& r) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  constexpr int capacity = Friction<Size>::ideal;
  bool independent = true;
  for_each<Source, Size::pins>(scene.pins, [&](int p) SLIDEWAY_FOLD {
    Meeting& at = fr.meeting[p];
    meeting(source, k, p, at);
    metric_row(source, k, d, table.pin[p], at.place, {1, 0}, fr.Q[2 * p]);
    metric_row(source, k, d, table.pin[p], at.place, {0, 1}, fr.Q[2 * p + 1]);
    const Vec2 target = {-gains.known * at.gamma.x - gains.alpha * at.rate.x - gains.beta * at.Phi.x,
                         -gains.known * at.gamma.y - gains.alpha * at.rate.y - gains.beta * at.Phi.y};
    fr.e[2 * p] = fr.ideal_target[2 * p] = target.x;
    fr.e[2 * p + 1] = fr.ideal_target[2 * p + 1] = target.y;
    r.drift_position = larger(r.drift_position, larger(std::fabs(at.Phi.x), std::fabs(at.Phi.y)));
    r.drift_velocity = larger(r.drift_velocity, larger(std::fabs(at.rate.x), std::fabs(at.rate.y)));
  });
  for_each<Source, Size::contacts>(table.contacts, [&](int c) SLIDEWAY_FOLD {
    const int g = table.guide_of[c];
    if (table.is_rough[g]) return;
    const Sliding& sl = fr.sliding[g];
    const Vec2 place = c == table.first_contact[g] ? sl.place : sl.place + sl.along * sl.t + sl.across * sl.n;
    metric_row(source, k, d, table.guide[g], place, sl.n, fr.Q[table.row_of[c]]);
    fr.e[table.row_of[c]] = fr.target[c];
  });
  for_each<Source, capacity>(table.ideal, [&](int m) SLIDEWAY_FOLD {
    if (!independent) return;
    independent = orthonormalise(source, fr, m);
    if (!independent) return;
    each_ideal_before(source, m, [&](int i) SLIDEWAY_FOLD { fr.e[m] -= fr.R[m][i] * fr.e[i]; });
    fr.e[m] /= fr.R[m][m];
    const int part = table.part_of_ideal[m];
    const double lack = fr.e[m] - inner(source, part, fr.Q[m], fr.u0);
    add_scaled(source, part, lack, fr.Q[m], fr.u0);
  });
  return independent;
}

/// A row of a part, less what it has along the ideal rows.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void clear_of_ideal(const Source& source, int part, const Friction<Size>& fr, const double* row,
                                    double* rest) noexcept {
  each_in_part(source, part, [&](int f) SLIDEWAY_FOLD { rest[f] = row[f]; });
  for_each<Source, Friction<Size>::ideal>(source.tables.ideal, [&](int i) SLIDEWAY_FOLD {
    if (source.tables.part_of_ideal[i] != part) return;
    add_scaled(source, part, -inner(source, part, fr.Q[i], rest), fr.Q[i], rest);
  });
}

/// |n + s e|^2
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double squared_length(const Source& source, int part, const double* n, const double* e,
                                      double s) noexcept {
  return inner(source, part, n, n) + s * (2 * inner(source, part, n, e) + s * inner(source, part, e, e));
}

/// Geometry of all contacts, the targets c, the sliding speeds and, if `measure`, the drift. Linear in the contacts.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void place_contacts(const Source& source, const Kinematics<Size>& k, Gains gains, bool measure,
                                    Friction<Size>& fr, Reaction<Size>& r) noexcept {
  const auto& table = source.tables;
  for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
    Sliding& s = fr.sliding[g];
    sliding(source, k, g, s);
    r.slip[g] = s.slip[0];
    for_each<Source, 2>(source.scene.guide[g].contacts, [&](int i) SLIDEWAY_FOLD {
      fr.target[table.first_contact[g] + i] =
          -gains.known * s.gamma[i] - gains.alpha * s.Phi_rate[i] - gains.beta * s.Phi[i];
      if (!measure) return;
      r.drift_position = larger(r.drift_position, std::fabs(s.Phi[i]));
      r.drift_velocity = larger(r.drift_velocity, std::fabs(s.Phi_rate[i]));
    });
  });
}

/// Viscous and preload friction, -viscous v - preload sgn(v), as wrenches on the bodies. At rest the preload is part of
/// what holds the guide, and not among them.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void apply_steady_friction(const Source& source, const signed char* mode, Friction<Size>& fr,
                                           Dynamics<Size>& d) noexcept {
  for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
    if (!source.tables.is_steady[g]) return;
    const Guide& guide = source.scene.guide[g];
    const Sliding& s = fr.sliding[g];
    fr.steady[g] = -guide.viscous * s.slip[0] - mode[g] * guide.preload;
    const Vec2 force = fr.steady[g] * s.t;
    d.applied[guide.slider].force = d.applied[guide.slider].force + force;
    d.applied[guide.slider].moment += cross(s.on_slider, force);
    if (guide.rail == ground) return;
    d.applied[guide.rail].force = d.applied[guide.rail].force - force;
    d.applied[guide.rail].moment -= cross(s.on_rail, force);
  });
}

/// Rows and right side of rough guide g, of a part.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void guide_rows(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d, int part,
                                int g, Friction<Size>& fr) noexcept {
  const auto& table = source.tables;
  const Link<Size>& link = table.guide[g];
  const Sliding& s = fr.sliding[g];
  const int c = table.first_contact[g];
  const bool two = source.scene.guide[g].contacts == 2;
  double *N = fr.N[g], *T = fr.T[g], *E = fr.E[g];
  for_each<Source, Size::coordinates>(link.fills, [&](int e) SLIDEWAY_FOLD {
    const int f = link.fill[e];
    N[f] = T[f] = 0;
    if (two) E[f] = 0;
  });
  for_each<Source, Size::coordinates>(link.columns, [&](int e) SLIDEWAY_FOLD {
    const int j = link.column[e], f = table.free_of[j], i = table.body_of[j];
    if (f == none) return;
    const Vec2 per_speed = column(table.motion[j], k.frame[i], s.place - k.origin[i], link.side[e]);
    N[f] = dot(s.n, per_speed);
    T[f] = dot(s.t, per_speed);
    if (two && table.motion[j] == Motion::turn) E[f] = link.side[e];
  });
  if (two) {
    to_metric(source, d, link.fill, link.fills, N, T, E);
  } else {
    to_metric(source, d, link.fill, link.fills, N, T);
  }
  if (table.has_ideal[part]) clear_of_ideal(source, part, fr, N, fr.N_clear[g]);
  if (table.has_ideal[part] && two) clear_of_ideal(source, part, fr, E, fr.E_clear[g]);
  double moved = 0, turned = 0;
  for_each<Source, Size::coordinates>(link.fills, [&](int e) SLIDEWAY_FOLD {
    const int f = link.fill[e];
    moved += N[f] * fr.u0[f];
    if (two) turned += E[f] * fr.u0[f];
  });
  fr.right[c] = fr.target[c] - moved;
  if (two) fr.right[c + 1] = fr.target[c + 1] - moved - s.along * turned;
}

/// S and S* between the contacts of a part's rough guides g (rows) and o (columns): with s and f for along and across,
///   S_ij = NN + s_i EN + s_j NE + s_i s_j EE,  S*_ij = sigma_o (NT + s_i ET - f_j (NE + s_i EE)),  s_0 = f_0 = 0.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void couple(const Source& source, int part, int g, int o, const Friction<Size>& fr,
                            Problem<Source>& hlcp) noexcept {
  const auto& table = source.tables;
  const auto& scene = source.scene;
  const Link<Size>& link = table.guide[g];
  constexpr int room = most_rows<Source>;
  const bool two = room > 1 && scene.guide[g].contacts == 2, other_two = room > 1 && scene.guide[o].contacts == 2;
  const bool clear = table.has_ideal[part];
  const auto& N = clear ? fr.N_clear[g] : fr.N[g];
  const auto& E = clear ? fr.E_clear[g] : fr.E[g];
  const auto& N_o = clear ? fr.N_clear[o] : fr.N[o];
  const auto& E_o = clear ? fr.E_clear[o] : fr.E[o];
  double NN = 0, NT = 0, EN = 0, ET = 0, NE = 0, EE = 0;
  for_each<Source, Size::coordinates>(link.fills, [&](int e) SLIDEWAY_FOLD {
    const int f = link.fill[e];
    if (!table.guide[o].filled[f]) return;
    NN += N[f] * N_o[f];
    NT += N[f] * fr.T[o][f];
    if (two) EN += E[f] * N_o[f];
    if (two) ET += E[f] * fr.T[o][f];
    if (other_two) NE += N[f] * E_o[f];
    if (two && other_two) EE += E[f] * E_o[f];
  });
  const int m = table.row_of[table.first_contact[g]], w = table.row_of[table.first_contact[o]];
  const double sigma = fr.sigma[o], s = fr.sliding[g].along, s_o = fr.sliding[o].along, f_o = fr.sliding[o].across;
  const auto set = [&](int i, int j, double S, double S_star) SLIDEWAY_FOLD {
    hlcp.plus[m + i][w + j] = S + S_star;
    hlcp.minus[m + i][w + j] = S - S_star;
  };
  set(0, 0, NN, sigma * NT);
  if (two) set(1, 0, NN + s * EN, sigma * (NT + s * ET));
  if (other_two) set(0, 1, NN + s_o * NE, sigma * (NT - f_o * NE));
  if (two && other_two) {
    set(1, 1, NN + s * EN + s_o * (NE + s * EE), sigma * (NT + s * ET - f_o * (NE + s * EE)));
  }
}

/// u0 and friction's coefficients, given the slip direction of each guide; those at rest bring no friction here. False
/// when ideal rows are redundant.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool assemble(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d, Gains gains,
                              const signed char* mode, Friction<Size>& fr, Reaction<Size>& r) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  for_each<Source, Size::coordinates>(table.free,
                                      [&](int f) SLIDEWAY_FOLD { fr.free_motion[f] = d.h[table.free_coordinate[f]]; });
  to_metric(source, d, table.every, table.free, fr.free_motion);
  for_each<Source, Size::coordinates>(table.free, [&](int f) SLIDEWAY_FOLD { fr.u0[f] = fr.free_motion[f]; });
  for_each<Source, Size::guides>(scene.guides, [&](int g) SLIDEWAY_FOLD {
    fr.sigma[g] = mode[g] > 0 ? -scene.guide[g].mu : mode[g] < 0 ? scene.guide[g].mu : 0;
    fr.stiction[g] = 0;
  });
  for_each<Source, Size::contacts>(table.contacts, [&](int c) SLIDEWAY_FOLD { fr.face[c] = 1; });
  return table.ideal == 0 || eliminate_ideal(source, k, d, gains, fr, r);
}

/// The rows, S, S* and b of a part's rough contacts. False when rank is lost. Cost: guides^2 times the overlap of their
/// paths.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool assemble_part(const Source& source, const Kinematics<Size>& k, const Dynamics<Size>& d, int part,
                                   Friction<Size>& fr, Problem<Source>& hlcp) noexcept {
  const auto& table = source.tables;
  bool independent = true;
  each_guide_in_part(source, part, [&](int g) SLIDEWAY_FOLD { guide_rows(source, k, d, part, g, fr); });
  each_guide_in_part(source, part, [&](int g) SLIDEWAY_FOLD {
    each_guide_in_part(source, part, [&](int o) SLIDEWAY_FOLD { couple(source, part, g, o, fr, hlcp); });
  });
  each_row_in_part(source, part, [&](int m, int c) SLIDEWAY_FOLD {
    hlcp.b[m] = fr.right[c];
    double squared = 0.5 * (hlcp.plus[m][m] + hlcp.minus[m][m]);
    if (table.has_ideal[part]) {  // S has what the ideal rows leave of the row
      const int g = table.guide_of[c];
      const bool first = c == table.first_contact[g];
      const double whole =
          squared_length(source, part, fr.N[g], first ? fr.N[g] : fr.E[g], first ? 0 : fr.sliding[g].along);
      const double bound = rank_bound(source);
      independent = independent && squared > bound * bound * whole;
      squared = whole;
    }
    fr.norm[c] = std::sqrt(squared);
  });
  return independent;
}

/// Are the rough contacts' rows independent? Cholesky's pivots of S are the squared distances of each row from the span
/// of those before it; formed with a relative error of n eps, they say nothing below that. Asked when the HLCP has no
/// single answer: redundant contacts are then the reason. Cost: n^3 / 6.
template <int Capacity>
inline bool independent_contacts(const Hlcp<Capacity>& hlcp, int n) noexcept {
  double S[Capacity][Capacity];
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) S[i][j] = 0.5 * (hlcp.plus[i][j] + hlcp.minus[i][j]);
  }
  for (int k = 0; k < n; ++k) {
    const double whole = 0.5 * (hlcp.plus[k][k] + hlcp.minus[k][k]);
    if (!(S[k][k] > 8 * detail::epsilon * n * whole)) return false;
    for (int i = k + 1; i < n; ++i) {
      const double ratio = S[i][k] / S[k][k];
      for (int j = k + 1; j <= i; ++j) S[i][j] -= ratio * S[j][k];
    }
  }
  return true;
}

/// Do contact forces of these signs have six digits? Entries of W(s) carry roundings of eps times the sizes of S and
/// S*: true if each pivot of Gauss's elimination keeps 2^-30 of the sizes of its terms, whatever the units of rows and
/// columns. Cost: 2 n^3 / 3.
template <int Capacity>
[[gnu::noinline]] inline bool has_digits(const Hlcp<Capacity>& hlcp, int n, const signed char* sign) noexcept {
  double W[Capacity][Capacity], terms[Capacity][Capacity], own[Capacity];
  for (int i = 0; i < n; ++i) {
    own[i] = 0.5 * (hlcp.plus[i][i] + hlcp.minus[i][i]);
    for (int j = 0; j < n; ++j) {
      W[i][j] = sign[j] < 0 ? hlcp.minus[i][j] : hlcp.plus[i][j];
      terms[i][j] = larger(std::fabs(hlcp.plus[i][j]), std::fabs(hlcp.minus[i][j]));
    }
  }
  for (int k = 0; k < n; ++k) {
    int pivot = k;  // of the row that has most in column k, beside its own length
    for (int i = k + 1; i < n; ++i) {
      if (W[i][k] * W[i][k] * own[pivot] > W[pivot][k] * W[pivot][k] * own[i]) pivot = i;
    }
    for (int j = k; j < n && pivot != k; ++j) {
      std::swap(W[k][j], W[pivot][j]);
      std::swap(terms[k][j], terms[pivot][j]);
    }
    own[pivot] = own[k];
    if (!(std::fabs(W[k][k]) > 0x1p-30 * terms[k][k])) return false;
    for (int i = k + 1; i < n; ++i) {
      const double ratio = W[i][k] / W[k][k];
      for (int j = k + 1; j < n; ++j) {
        W[i][j] -= ratio * W[k][j];
        terms[i][j] += std::fabs(ratio) * terms[k][j];
      }
    }
  }
  return true;
}

}  // namespace slideway
