// The equations of guides at rest in a given mode: contact forces and the friction that holds them, by one linear
// solve.
#pragma once

#include <slideway/basis.hpp>
#include <slideway/hlcp_follow.hpp>

namespace slideway {

/// The largest problem of guides at rest, before it is held to what the HLCP solver takes.
template <class Source>
inline constexpr int rest_order = most_rows<Source> + 2 * most_guides<Source>;

/// What one evaluation leaves to the next.
template <class Size>
struct Modes {
  static constexpr int n_guides = at_least_one(Size::guides);
  signed char mode[n_guides];                      ///< +1, -1: slip direction; 0: at rest
  signed char sign[at_least_one(Size::contacts)];  ///< of each contact force
  bool decided;                                    ///< mode and sign hold; false: only the sliding speed tells
  bool still[n_guides];                            ///< its sliding speed counts as zero, whatever rounding says
  bool leaving[n_guides];       ///< broke away at this instant: mu acts on it from now on, wherever it goes
  bool bound[n_guides];         ///< at rest, and its row is imposed: it does not follow from others
  double stiction[n_guides];    ///< of a guide at rest that is not bound: its share of the friction, N
  double limit_left[n_guides];  ///< of a guide at rest: static limit less |friction|, N
  double rounding;              ///< of the sum that u = G q'' is
  double state_rounding;        ///< of what Baumgarte's terms make of a state in doubles, m/s^2
  double norm[at_least_one(Size::contacts)];  ///< |N~| of each rough contact
  double own[at_least_one(Size::contacts)];   ///< |N~|^2 less what its guide's other contact has of it, 1/kg

  /// Rounding of a contact force, N.
  constexpr double noise(int c) const noexcept { return detail::quotient(rounding * norm[c] + state_rounding, own[c]); }
  /// And of the v' of a guide whose first contact is c, m/s^2.
  constexpr double motion_noise(int c) const noexcept { return rounding * norm[c]; }
};

/// Guides of one part whose sliding speed is zero at one instant, the `set`: their rows beside those of the contacts,
/// and the problem in a given mode. T^ and so on as in friction.hpp.
template <class Source>
class RestEquations {
 public:
  using Size = typename Source::Size;
  static constexpr int n_free = at_least_one(Size::coordinates), n_guides = at_least_one(Size::guides),
                       n_contacts = at_least_one(Size::contacts),
                       order = at_least_one(rest_order<Source> < hlcp_max_order ? rest_order<Source> : hlcp_max_order);

  RestEquations(const Source& source, int part, Friction<Size>& fr, Problem<Source>& sliding) noexcept
      : source_(source),
        table_(source.tables),
        part_(part),
        first_row_(table_.first_row[part]),
        rows_(row_count(table_, part)),
        fr_(fr),
        sliding_(sliding) {}

  /// Guide g is at rest. `hold`: what keeps it there is T q'' = hold, m/s^2. `coefficient`: mu of the limit.
  void add(int g, double hold, double coefficient) noexcept {
    set_[count_++] = g;
    coefficient_[g] = coefficient;
    double* T = T_[g];
    if (table_.ideal > 0) {
      clear_of_ideal(source_, part_, fr_, fr_.T[g], T);
    } else {
      each_in_part(source_, part_, [&](int f) { T[f] = fr_.T[g][f]; });
    }
    lack_[g] = hold - inner(source_, part_, fr_.T[g], fr_.u0);
    mobility_[g] = inner(source_, part_, fr_.N[g], fr_.N[g]) + inner(source_, part_, fr_.T[g], fr_.T[g]);
    // Terms of `lack`: u0 with the row's length, and what hold is made of.
    scale_[g] = std::sqrt(mobility_[g] * inner(source_, part_, fr_.u0, fr_.u0)) + std::fabs(hold);
  }

  /// Contact forces and stiction in the modes and with the signs of m, whether or not they are allowed there: one
  /// linear solve of order contacts + bound guides. False when the matrix is singular or the residual too large.
  bool solve_in_mode(const Modes<Size>& m, double* lambda) noexcept {
    for (int i = 0; i < count_; ++i) known_[set_[i]] = known_force(m, set_[i]);
    build_in_mode(m);
    if (!attempt(m)) return false;
    for (int r = 0; r < rows_; ++r) lambda[contact(r)] = trial_.x[r];
    for (int i = 0; i < count_; ++i) fr_.stiction[set_[i]] = known_[set_[i]];
    for (int h = 0; h < bound_count_; ++h) fr_.stiction[bound_[h]] = trial_.x[rows_ + h];
    return true;
  }

  /// Static limit less |friction| of a guide at rest, with the contact forces of the mode.
  double limit_left(int g, const double* lambda) const noexcept {
    double limit = source_.scene.guide[g].preload;
    for (int i = 0; i < source_.scene.guide[g].contacts; ++i) {
      const int c = table_.first_contact[g] + i;
      limit += source_.scene.guide[g].mu_static * (fr_.face[c] * lambda[c]);
    }
    return limit - std::fabs(fr_.stiction[g]);
  }

 protected:
  const double* N(int g) const noexcept { return table_.has_ideal[part_] ? fr_.N_clear[g] : fr_.N[g]; }
  const double* E(int g) const noexcept { return table_.has_ideal[part_] ? fr_.E_clear[g] : fr_.E[g]; }
  int contact(int row) const noexcept { return table_.rough_contact[first_row_ + row]; }
  bool is_second(int c) const noexcept { return c != table_.first_contact[table_.guide_of[c]]; }

  /// N^_c . x of contact c.
  double normal(int c, const double* x) const noexcept {
    const int g = table_.guide_of[c];
    const double first = inner(source_, part_, N(g), x);
    return is_second(c) ? first + fr_.sliding[g].along * inner(source_, part_, E(g), x) : first;
  }

  /// x . T_c of contact c, x clear of the ideal rows.
  double tangential(int c, const double* x) const noexcept {
    const int g = table_.guide_of[c];
    const double first = inner(source_, part_, fr_.T[g], x);
    return is_second(c) ? first - fr_.sliding[g].across * inner(source_, part_, fr_.E[g], x) : first;
  }

  /// The contacts' rows, and the part of u - u0 that they decide.
  void span_contacts() noexcept {
    basis_.forget(0);
    for (int r = 0; r < rows_; ++r) {
      const int c = contact(r), g = table_.guide_of[c];
      double* row = basis_.next();
      each_in_part(source_, part_, [&](int f) {
        row[f] = N(g)[f];
        if (is_second(c)) row[f] += fr_.sliding[g].along * E(g)[f];
      });
      basis_.take(part_, fr_.norm[c], sliding_.b[r]);
    }
    contact_rows_ = basis_.count;
  }

  /// Takes guide g's row into the basis; false, and nothing done, if it is a combination of those there.
  bool take_guide(int g) noexcept {
    double* row = basis_.next();
    each_in_part(source_, part_, [&](int f) { row[f] = T_[g][f]; });
    return basis_.take(part_, std::sqrt(mobility_[g]), lack_[g]);
  }

  /// v' + alpha v that the basis leaves to a guide whose row is in its span.
  double excess(int g) const noexcept { return inner(source_, part_, T_[g], basis_.change) - lack_[g]; }

  /// What rounding makes of that: terms of both, some tens of roundings each.
  double excess_bound(int g) const noexcept { return bound_of(g, basis_.change); }

  double bound_of(int g, const double* u) const noexcept {
    return 64 * rank_bound(source_) * (scale_[g] + std::sqrt(mobility_[g] * inner(source_, part_, u, u)));
  }

  /// Of a guide at rest before: what its preload does once it slips, and its share if it is held but not bound. N
  double known_force(const Modes<Size>& m, int g) const noexcept {
    if (m.mode[g] != 0) return -m.mode[g] * source_.scene.guide[g].preload;
    return m.bound[g] ? 0 : m.stiction[g];
  }

  /// Friction of the guides in the set as their modes say, in the contacts' columns.
  void set_sigma(const Modes<Size>& m) noexcept {
    for (int i = 0; i < count_; ++i) {
      const int o = set_[i];
      const double sigma = -m.mode[o] * coefficient_[o];
      if (sigma == fr_.sigma[o]) continue;
      fr_.sigma[o] = sigma;
      each_guide_in_part(source_, part_, [&](int g) { couple(source_, part_, g, o, fr_, sliding_); });
    }
  }

  /// The contacts' block and right side. Open guides bring friction as an unknown, the others a known force.
  void start_problem(int size) noexcept {
    size_ = size;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) {
        const bool old = i < rows_ && j < rows_;
        problem_.plus[i][j] = old ? sliding_.plus[i][j] : 0;
        problem_.minus[i][j] = old ? sliding_.minus[i][j] : 0;
      }
      problem_.b[i] = i < rows_ ? sliding_.b[i] : 0;
    }
    for (int i = 0; i < count_; ++i) {
      const double force = known_[set_[i]];
      if (force == 0) continue;
      for (int r = 0; r < rows_; ++r) problem_.b[r] -= normal(contact(r), T_[set_[i]]) * force;
    }
  }

  /// Row `row` = T q'' of guide g in the contact forces; its right side.
  void set_motion_row(int row, int g) noexcept {
    for (int r = 0; r < rows_; ++r) {
      const int c = contact(r);
      const double S = normal(c, T_[g]), S_star = fr_.sigma[table_.guide_of[c]] * tangential(c, T_[g]);
      problem_.plus[row][r] = S + S_star;
      problem_.minus[row][r] = S - S_star;
    }
    problem_.b[row] = lack_[g];
    for (int i = 0; i < count_; ++i) {
      if (known_[set_[i]] != 0) problem_.b[row] -= inner(source_, part_, T_[g], T_[set_[i]]) * known_[set_[i]];
    }
  }

  /// In given modes: the bound guides' friction is one unknown each, with the row v' = -alpha v.
  void build_in_mode(const Modes<Size>& m) noexcept {
    set_sigma(m);
    bound_count_ = 0;
    for (int i = 0; i < count_; ++i) {
      if (m.mode[set_[i]] == 0 && m.bound[set_[i]]) bound_[bound_count_++] = set_[i];
    }
    const int n = rows_;
    start_problem(n + bound_count_);
    for (int h = 0; h < bound_count_; ++h) {
      const int g = bound_[h];
      set_motion_row(n + h, g);
      for (int r = 0; r < n; ++r) {
        problem_.plus[r][n + h] = problem_.minus[r][n + h] = normal(contact(r), T_[g]);
      }
      for (int o = 0; o < bound_count_; ++o) {
        problem_.plus[n + h][n + o] = problem_.minus[n + h][n + o] = inner(source_, part_, T_[g], T_[bound_[o]]);
      }
    }
  }

  /// One linear solve with the contact signs of m. x in trial_.
  bool attempt(const Modes<Size>& m) noexcept {
    for (int r = 0; r < size_; ++r) sign_[r] = r < rows_ ? m.sign[contact(r)] : 1;
    ++trials_;
    return hlcp_detail::attempt(problem_, size_, sign_, trial_);
  }

  /// u - u0 from contact forces, the friction of the set and that of guides that slip.
  void gain(const Modes<Size>& m, const double* lambda, double* u) const noexcept {
    each_in_part(source_, part_, [&](int f) { u[f] = 0; });
    for (int r = 0; r < rows_; ++r) {
      const int c = contact(r), g = table_.guide_of[c];
      const double s = is_second(c) ? fr_.sliding[g].along : 0, across = is_second(c) ? fr_.sliding[g].across : 0;
      const double friction = fr_.sigma[g] * (m.sign[c] < 0 ? -lambda[c] : lambda[c]);
      each_in_part(source_, part_, [&](int f) {
        u[f] += lambda[c] * (N(g)[f] + (s != 0 ? s * E(g)[f] : 0)) +
                friction * (fr_.T[g][f] - (across != 0 ? across * fr_.E[g][f] : 0));
      });
    }
    for (int i = 0; i < count_; ++i) add_scaled(source_, part_, fr_.stiction[set_[i]], T_[set_[i]], u);
  }

  const Source& source_;
  const Tables<Size>& table_;
  const int part_, first_row_, rows_;  ///< the part, and its rough contacts
  Friction<Size>& fr_;
  Problem<Source>& sliding_;

  int set_[n_guides], count_ = 0;
  double T_[n_guides][n_free];    ///< T^
  double lack_[n_guides];         ///< T^ (u - u0) that rest asks for, m/s^2
  double mobility_[n_guides];     ///< |N~|^2 + |T~|^2 of the first contact, 1/kg
  double scale_[n_guides];        ///< of lack's terms, m/s^2
  double coefficient_[n_guides];  ///< mu_static, or mu of those that leave
  double known_[n_guides] = {};   ///< friction that is not an unknown, N

  Basis<Source, at_least_one(most_rows<Source> + most_guides<Source>)> basis_{source_};
  int contact_rows_ = 0;

  int bound_[n_guides], bound_count_ = 0;  ///< guides whose friction is an unknown
  int size_ = 0, trials_ = 0;
  signed char sign_[order];
  Hlcp<order> problem_;
  hlcp_detail::Trial<order> trial_;
};

}  // namespace slideway
