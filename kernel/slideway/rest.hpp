// Guides at rest: which of them stay, which break away and whither, and the friction that holds them.
//
// Coulomb's law at rest is set-valued: |F| <= c Lambda + p with v' = 0, or F = -+(c Lambda + p) with v' to the side of
// +-. With two unknowns a guide, y+ and y-, and xi = max(y, 0), a = max(-y, 0) of each, it is
//
//   y+ + y- = 2 (c Lambda + p),   F = (|y+| - |y-|) / 2,   v' + alpha v = kappa (a+ - a-):
//
// both positive: held; y+ < 0: the guide leaves in the direction of `direction`, y- < 0: against it. Together with the
// contacts' rows this is a problem A+ x+ - A- x- = b again, of order contacts + 2 guides at rest, for the same solver.
// kappa, the contact's mobility, only brings a to the size of a force. -alpha v instead of 0: a guide held on a moving
// mechanism would creep by what a step's truncation leaves.
//
// Where a guide's row is a combination of the contacts' and the ideal rows, friction cannot change its motion: it
// slides as v' says, or it dwells, and its friction is a choice. Where guides at rest outnumber the freedom, so is a
// part of theirs. Then every mode is tried, rest first, and the forces are those of least norm: the sum of the squares
// of the stiction forces, the one that guides alike in their tangential stiffness would share, in the limit of rigid
// ones.
#pragma once

#include <slideway/jam.hpp>

namespace slideway {

/// The rest problem of one instant.
template <class Source>
class RestProblem : public JammedGuides<Source> {
 public:
  using Base = JammedGuides<Source>;
  using Base::Base, Base::n_contacts, Base::n_free, Base::n_guides, Base::order;
  using Base::solve_in_mode;
  using typename Base::Size;

  /// Modes of the guides that were added, contact signs, and which rows hold; m in and out. A guide that comes with a
  /// mode other than 0 keeps it if it gains speed that way. mu_static decides who leaves, mu acts on those that do:
  /// solved again until no guide joins them (at most guides + 1 rounds) or turns back (as many). Where sliding as
  /// proposed has no solution the law is asked without the proposal.
  Status decide(Modes<Size>& m, Report& report) noexcept {
    span_contacts();
    find_determined(m);
    for (int round = 0; round < 2 * Size::guides + 3; ++round) {
      for (int i = 0; i < count_; ++i) candidate_[set_[i]] = m.mode[set_[i]];
      const Status status = jammed_ ? decide_jammed(m, report) : decide_regular(m, report);
      if (status == Status::no_solution && withdraw(m)) continue;
      if (status != Status::ok) return status;
      if (!turn_back(m) && !break_away(m)) return Status::ok;
    }
    return Status::no_convergence;
  }

 private:
  using Base::bound_of, Base::contact, Base::decide_jammed, Base::excess, Base::excess_bound, Base::gain,
      Base::hlcp_solve, Base::known_force, Base::normal, Base::note, Base::set_motion_row, Base::set_sigma,
      Base::span_contacts, Base::start_problem, Base::take_guide;
  using Base::source_, Base::table_, Base::part_, Base::rows_, Base::fr_, Base::set_, Base::count_, Base::T_,
      Base::lack_, Base::mobility_, Base::coefficient_, Base::known_, Base::basis_, Base::contact_rows_, Base::open_,
      Base::open_count_, Base::size_, Base::problem_, Base::roundings_, Base::fixed_, Base::dwells_, Base::jammed_,
      Base::options_;

  /// Guides whose motion friction cannot change: they slide as v' says, or dwell. And whether the others' rows depend
  /// on each other.
  void find_determined(Modes<Size>& m) noexcept {
    jammed_ = false;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      fixed_[g] = dwells_[g] = false;
      if (take_guide(g)) {
        basis_.forget(contact_rows_);  // the next is held against the contacts alone, too
        continue;
      }
      const double v = excess(g);
      fixed_[g] = std::fabs(v) > excess_bound(g) + roundings_;
      dwells_[g] = !fixed_[g];
      m.mode[g] = static_cast<signed char>(!fixed_[g] ? 0 : v > 0 ? 1 : -1);
      if (fixed_[g]) coefficient_[g] = source_.scene.guide[g].mu;
      jammed_ = jammed_ || dwells_[g];
    }
    for (int i = 0; i < count_; ++i) {
      if (!fixed_[set_[i]] && !dwells_[set_[i]] && !take_guide(set_[i])) jammed_ = true;
    }
    basis_.forget(contact_rows_);
  }

  /// The set-valued law for all guides whose mode is open: two unknowns each.
  void build_set_valued(const Modes<Size>& m) noexcept {
    set_sigma(m);
    const int n = rows_;
    start_problem(n + 2 * open_count_);
    for (int i = 0; i < open_count_; ++i) {
      const int g = open_[i], limit = n + 2 * i, motion = limit + 1;
      for (int r = 0; r < n; ++r) {
        const double half = 0.5 * normal(contact(r), T_[g]);
        set_friction_columns(r, i, half);
        if (table_.guide_of[contact(r)] == g) {
          problem_.plus[limit][r] = -2 * coefficient_[g];
          problem_.minus[limit][r] = 2 * coefficient_[g];
        }
      }
      problem_.plus[limit][limit] = problem_.minus[limit][limit] = 1;
      problem_.plus[limit][motion] = problem_.minus[limit][motion] = 1;
      problem_.b[limit] = 2 * source_.scene.guide[g].preload;
      set_motion_row(motion, g);
      for (int o = 0; o < open_count_; ++o) {
        set_friction_columns(motion, o, 0.5 * inner(source_, part_, T_[g], T_[open_[o]]));
      }
      // Less kappa (a+ - a-), a = (|y| - y) / 2: nothing where y > 0.
      problem_.minus[motion][limit] += mobility_[g];
      problem_.minus[motion][motion] -= mobility_[g];
    }
  }

  /// F = (|y+| - |y-|) / 2 of the i-th open guide, times 2 half, in a row.
  void set_friction_columns(int row, int i, double half) noexcept {
    const int first = rows_ + 2 * i;
    problem_.plus[row][first] = half;
    problem_.minus[row][first] = -half;
    problem_.plus[row][first + 1] = -half;
    problem_.minus[row][first + 1] = half;
  }

  /// Guides at rest, none of them redundant: the complementarity problem above.
  Status decide_regular(Modes<Size>& m, Report& report) noexcept {
    open_count_ = 0;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      known_[g] = 0;
      if (m.mode[g] == 0) {
        open_[open_count_++] = g;
      } else {
        known_[g] = known_force(m, g);
      }
    }
    const int n = rows_;
    if (n + 2 * open_count_ > order) return Status::solve_limit;
    build_set_valued(m);
    HlcpSolution<order> answer;
    for (int r = 0; r < size_; ++r) answer.sign[r] = r < n ? m.sign[contact(r)] : 1;
    hlcp_solve(answer);
    note(report, answer.uniqueness, answer.solves);
    if (answer.status != Status::ok) return answer.status;
    double largest = 0;
    for (int r = 0; r < size_; ++r) largest = larger(largest, std::fabs(answer.x[r]));
    for (int r = 0; r < n; ++r) m.sign[contact(r)] = answer.sign[r];
    // An a below the answer's own rounding (its residual bound, 64 times for the condition) is none: rest is preferred.
    const double still = 64 * 5 * (size_ + 1) * 0x1p-53 * largest;
    for (int i = 0; i < open_count_; ++i) {
      const double* y = answer.x + n + 2 * i;
      m.mode[open_[i]] = static_cast<signed char>(y[0] < -still ? 1 : y[1] < -still ? -1 : 0);
      m.bound[open_[i]] = true;
    }
    return Status::ok;
  }

  /// Guides that came with a mode are open, too; true if there is one.
  bool withdraw(Modes<Size>& m) noexcept {
    bool any = false;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      if (candidate_[g] == 0 || fixed_[g]) continue;
      m.mode[g] = 0;
      any = true;
    }
    return any;
  }

  /// Guides that took part with a mode, and would lose speed that way, are at rest; true if there is one.
  bool turn_back(Modes<Size>& m) noexcept {
    bool any = false;
    for (int i = 0; i < count_ && !any; ++i) any = candidate_[set_[i]] != 0 && !fixed_[set_[i]];
    if (!any) return false;
    double lambda[n_contacts];
    if (!solve_in_mode(m, lambda)) return false;
    double u[n_free] = {};
    gain(m, lambda, u);
    bool turned = false;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      if (candidate_[g] == 0 || fixed_[g] ||
          m.mode[g] * (inner(source_, part_, T_[g], u) - lack_[g]) >= -bound_of(g, u))
        continue;
      m.mode[g] = 0;
      if (!m.leaving[g]) coefficient_[g] = source_.scene.guide[g].mu_static;
      turned = true;
    }
    if (turned) reopen(m);  // where they went beside those
    return turned;
  }

  /// Guides that leave by mu_static go on with mu; true if one is new among them.
  bool break_away(Modes<Size>& m) noexcept {
    bool grows = false;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      const double mu = source_.scene.guide[g].mu;
      if (m.mode[g] == 0 || candidate_[g] != 0 || coefficient_[g] == mu) continue;
      coefficient_[g] = mu;
      grows = true;
    }
    if (!grows) return false;
    reopen(m);
    return true;
  }

  /// The guides that took part without a mode are open again, set-valued.
  void reopen(Modes<Size>& m) const noexcept {
    for (int i = 0; i < count_; ++i) {
      if (!fixed_[set_[i]] && candidate_[set_[i]] == 0) m.mode[set_[i]] = 0;
    }
  }

  signed char candidate_[n_guides];  ///< modes that guides came with
};

}  // namespace slideway
