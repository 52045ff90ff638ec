// More guides at rest than freedom, or guides that dwell: every mode is tried, rest first, and of many admissible sets
// of stiction forces the one of least norm is taken.
//
// The norm is the sum of the squares of the stiction forces: what guides alike in their tangential stiffness would
// share, in the limit of rigid ones (Wojtyra, Multibody Syst. Dyn. 39, 2017, on why a choice is needed). The set is a
// polyhedron that moves continuously with the motion while the contact signs stay, and so does its point of least norm.
#pragma once

#include <slideway/least_norm.hpp>
#include <slideway/rest_equations.hpp>

namespace slideway {

template <class Source>
class JammedGuides : public RestEquations<Source> {
 public:
  using Base = RestEquations<Source>;
  using Base::n_contacts, Base::n_free, Base::n_guides, Base::order;
  using typename Base::Size;

  JammedGuides(const Source& source, int part, const HlcpOptions& options, Friction<Size>& fr,
               Problem<Source>& sliding) noexcept
      : Base(source, part, fr, sliding), options_(options) {}

  /// What roundings of the state, and speeds that are not quite zero, make of Baumgarte's terms, m/s^2: rows that
  /// follow from others are met but for that.
  void allow(double speeds, double roundings) noexcept {
    slack_ = speeds + roundings;
    roundings_ = roundings;
  }

 protected:
  using Base::attempt, Base::build_in_mode, Base::contact, Base::excess, Base::excess_bound, Base::gain,
      Base::known_force, Base::normal, Base::take_guide;
  using Base::source_, Base::table_, Base::part_, Base::rows_, Base::fr_, Base::set_, Base::count_, Base::T_,
      Base::lack_, Base::mobility_, Base::coefficient_, Base::known_, Base::basis_, Base::contact_rows_, Base::bound_,
      Base::bound_count_, Base::size_, Base::trials_, Base::problem_, Base::trial_;

  /// Every mode of the open guides, rest first; of each, contact signs from those before on. Capped at max_solves.
  /// Where that may be too few and guides move, the likeliest is tried first, by an HLCP, and is taken.
  Status decide_jammed(Modes<Size>& m, Report& report) noexcept {
    open_count_ = 0;
    for (int i = 0; i < count_; ++i) {
      if (m.mode[set_[i]] == 0 && !dwells_[set_[i]]) open_[open_count_++] = set_[i];
    }
    bool complete = true;
    Modes<Size> found = m, tried = m;
    int solutions = 0;
    long long modes = 1;
    for (int i = 0; i < open_count_; ++i) modes = modes > options_.max_solves ? modes : 3 * modes;
    long long trials = modes;
    for (int r = 0; r < rows_; ++r) trials = trials > options_.max_solves ? trials : 2 * trials;
    int guesses = 0;
    if (trials > options_.max_solves && go_on(m, guesses)) {
      note(report, Uniqueness::unproven, guesses);
      return Status::ok;
    }
    trials_ = 0;
    for (long long number = 0; number < modes && complete && solutions < 2; ++number) {
      long long digits = number;
      for (int i = 0; i < open_count_; ++i, digits /= 3) {
        tried.mode[open_[i]] = static_cast<signed char>(digits % 3 == 2 ? -1 : digits % 3);
      }
      const Feasible feasible = try_signs(m, tried);
      if (feasible == Feasible::unknown) complete = false;
      if (feasible != Feasible::yes) continue;
      if (solutions++ == 0) found = tried;
      if (solutions == 1 && options_.not_unique == NotUnique::continue_along_signs && number > 0) break;
    }
    if (solutions == 0) {
      note(report, Uniqueness::unproven, guesses + trials_);
      return complete ? Status::no_solution : Status::solve_limit;
    }
    const bool rests = held(found);
    note(report,
         solutions > 1         ? Uniqueness::refuted
         : !complete || !rests ? Uniqueness::unproven
                               : Uniqueness::motion_only,
         guesses + trials_);
    if (solutions > 1 && options_.not_unique == NotUnique::refuse) return Status::not_unique;
    m = found;
    return Status::ok;
  }

  bool held(const Modes<Size>& m) const noexcept {
    bool all = true;
    for (int i = 0; i < open_count_; ++i) all = all && m.mode[open_[i]] == 0;
    return all;
  }

  /// The likeliest mode: guides that move go on as contact forces without friction let them, the others rest; with the
  /// contact signs that solve it. False, and m as it was, if none moves or that is no solution.
  bool go_on(Modes<Size>& m, int& solves) noexcept {
    Modes<Size> tried = m;
    bool any = false;
    basis_.forget(contact_rows_);
    for (int i = 0; i < open_count_; ++i) {
      const int g = open_[i];
      const double v = m.leaving[g] ? excess(g) : 0;
      tried.mode[g] = static_cast<signed char>((v > 0) - (v < 0));
      any = any || v != 0;
    }
    if (!any || !bind(tried)) return false;
    for (int i = 0; i < count_; ++i) {
      tried.stiction[set_[i]] = 0;
      known_[set_[i]] = known_force(tried, set_[i]);
    }
    build_in_mode(tried);
    HlcpSolution<order> answer;
    for (int r = 0; r < size_; ++r) answer.sign[r] = r < rows_ ? m.sign[contact(r)] : 1;
    hlcp_solve(answer);
    solves = answer.solves;
    if (answer.status != Status::ok) return false;
    for (int r = 0; r < rows_; ++r) tried.sign[contact(r)] = answer.sign[r];
    if (!admits(tried)) return false;
    m = tried;
    return true;
  }

  /// A right side far below the rounding of the largest is none: alpha v of a guide at rest dies away exponentially,
  /// and an exact decision is one of numbers within 2^400 of each other.
  [[gnu::noinline]] void hlcp_solve(HlcpSolution<order>& answer) noexcept {
    double largest = 0;
    for (int r = 0; r < size_; ++r) largest = larger(largest, std::fabs(problem_.b[r]));
    for (int r = 0; r < size_; ++r) {
      if (std::fabs(problem_.b[r]) < 0x1p-150 * largest) problem_.b[r] = 0;
    }
    solve(problem_, size_, answer, options_);
  }

  enum class Feasible : unsigned char { no, yes, unknown };

  /// Contact signs for given modes: those of `m` first, then all others.
  Feasible try_signs(const Modes<Size>& m, Modes<Size>& tried) noexcept {
    if (!bind(tried)) return Feasible::no;
    const int n = rows_;
    const long long patterns = n < 40 ? 1LL << n : 1LL << 40;
    for (long long flips = 0; flips < patterns; ++flips) {
      if (trials_ >= options_.max_solves) return Feasible::unknown;
      for (int r = 0; r < n; ++r) {
        const int c = contact(r);
        const int sign = m.sign[c] < 0 ? -1 : 1;
        tried.sign[c] = static_cast<signed char>(r < 40 && ((flips >> r) & 1) != 0 ? -sign : sign);
      }
      if (admits(tried)) return Feasible::yes;
    }
    return Feasible::no;
  }

  /// Which of the guides held are bound: the first independent rows. False when the others do not rest with them.
  bool bind(Modes<Size>& m) noexcept {
    basis_.forget(contact_rows_);
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      m.bound[g] = m.mode[g] == 0 && !dwells_[g] && take_guide(g);
    }
    bool rests = true;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      // Rows that follow from others are met by them up to what speeds beside zero make of alpha v.
      if (m.mode[g] == 0 && !m.bound[g]) rests = rests && std::fabs(excess(g)) <= excess_bound(g) + slack_;
    }
    return rests;
  }

  /// Are there stiction forces for these modes and signs? Those of guides that are not bound are parameters, everything
  /// else is affine in them; the least norm goes into m.
  bool admits(Modes<Size>& m) noexcept {
    int parameter[n_guides] = {}, parameters = 0;
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      m.stiction[g] = 0;
      known_[g] = known_force(m, g);
      if (m.mode[g] == 0 && !m.bound[g]) parameter[parameters++] = g;
    }
    build_in_mode(m);
    if (!attempt(m)) return false;
    double x[n_guides + 1][order];  // of no parameter, and of each
    keep(x[0]);
    double size = 0;
    for (int r = 0; r < size_; ++r) size = larger(size, std::fabs(x[0][r]));
    if (!(size > 0)) size = 1;
    for (int p = 0; p < parameters; ++p) {
      respond(parameter[p]);
      keep(x[p + 1]);
    }
    if (parameters == 0) return meets(m, x, parameter, size);
    double s[n_guides] = {};
    if (!least_stiction(m, x, parameter, parameters, size, s)) return false;
    for (int p = 0; p < parameters; ++p) m.stiction[parameter[p]] = s[p];
    return true;
  }

  using Search =
      LeastNorm<at_least_one(most_rows<Source> + 3 * most_guides<Source>), at_least_one(most_guides<Source>)>;

  void keep(double* x) const noexcept {
    for (int r = 0; r < size_; ++r) x[r] = trial_.x[r];
  }

  /// trial_.x = what 1 N of friction at guide g changes in the solution.
  void respond(int g) noexcept {
    double rest[order];
    for (int r = 0; r < rows_; ++r) rest[r] = -normal(contact(r), T_[g]);
    for (int h = 0; h < bound_count_; ++h) rest[rows_ + h] = -inner(source_, part_, T_[bound_[h]], T_[g]);
    for (double& component : trial_.x) component = 0;
    hlcp_detail::correct(problem_, size_, rest, trial_);
  }

  /// f(row) for every inequality row . (1, s) >= 0 of the modes: faces, limits to both sides, and the directions of
  /// guides that leave. Coefficients are N, or m/s^2 over the mobility.
  template <class F>
  void each_condition(const Modes<Size>& m, const double (*x)[order], const int* parameter, int parameters, double size,
                      F&& f) noexcept {
    double row[n_guides + 1] = {};
    for (int r = 0; r < rows_; ++r) {
      for (int p = 0; p <= parameters; ++p) row[p] = m.sign[contact(r)] < 0 ? -x[p][r] : x[p][r];
      f(row, 0.0);
    }
    for (int i = 0; i < count_; ++i) {
      const int g = set_[i];
      if (m.mode[g] != 0) {
        if (fixed_[g]) continue;
        leaving_row(m, x, parameter, parameters, g, row);
        f(row, 0x1p-40 * size);  // a guide that gains no speed is at rest
        continue;
      }
      for (const int side : {1, -1}) {
        for (int p = 0; p <= parameters; ++p) {
          row[p] = p == 0 ? source_.scene.guide[g].preload : 0;
          for (int c = 0; c < source_.scene.guide[g].contacts; ++c) {
            const int r = table_.row_of[table_.first_contact[g]] + c;
            row[p] += coefficient_[g] * (m.sign[contact(r)] < 0 ? -x[p][r] : x[p][r]);
          }
          row[p] -= side * friction(m, x[p], parameter, p, g);
        }
        f(row, 0.0);
      }
    }
  }

  /// Friction of guide g in x[p]: of no parameter (p = 0) or of 1 N of the p-th.
  double friction(const Modes<Size>& m, const double* x, const int* parameter, int p, int g) const noexcept {
    if (!m.bound[g]) return p > 0 && parameter[p - 1] == g ? 1 : 0;
    int h = 0;
    while (bound_[h] != g) ++h;
    return x[rows_ + h];
  }

  void leaving_row(const Modes<Size>& m, const double (*x)[order], const int* parameter, int parameters, int g,
                   double* row) noexcept {
    for (int p = 0; p <= parameters; ++p) {
      double lambda[n_contacts], u[n_free] = {};
      for (int r = 0; r < rows_; ++r) lambda[contact(r)] = x[p][r];
      for (int i = 0; i < count_; ++i) {
        const int o = set_[i];
        fr_.stiction[o] = m.mode[o] != 0 ? (p == 0 ? known_[o] : 0) : friction(m, x[p], parameter, p, o);
      }
      gain(m, lambda, u);
      row[p] = m.mode[g] * (inner(source_, part_, T_[g], u) - (p == 0 ? lack_[g] : 0)) / mobility_[g];
    }
  }

  /// Without parameters: are all conditions met, to rounding?
  bool meets(const Modes<Size>& m, const double (*x)[order], const int* parameter, double size) noexcept {
    bool good = true;
    each_condition(m, x, parameter, 0, size, [&](const double* row, double least) {
      good = good && row[0] >= (least > 0 ? least : -4 * rank_bound(source_) * size);
    });
    return good;
  }

  /// s of least sum of squares of all stiction forces. With F = F_0 + B s of the bound guides that is
  /// |s|^2 + |F_0 + B s|^2 = |R (s - s_0)|^2 + const, R'R = I + B'B: the shortest z = R (s - s_0) / size is sought.
  bool least_stiction(const Modes<Size>& m, const double (*x)[order], const int* parameter, int parameters, double size,
                      double* s) noexcept {
    Search search;
    search.dimension = parameters;
    SLIDEWAY_ASSUME(parameters <= n_guides);
    const int n = rows_;
    double R[n_guides][n_guides] = {}, s_0[n_guides] = {};
    for (int p = 0; p < parameters; ++p) {
      s_0[p] = 0;
      for (int h = 0; h < bound_count_; ++h) s_0[p] -= x[p + 1][n + h] * x[0][n + h];
      for (int o = 0; o < parameters; ++o) {
        R[p][o] = p == o ? 1 : 0;
        for (int h = 0; h < bound_count_; ++h) R[p][o] += x[p + 1][n + h] * x[o + 1][n + h];
      }
    }
    for (int p = 0; p < parameters; ++p) {  // Cholesky: R upper triangular
      for (int o = 0; o < p; ++o) {
        for (int c = p; c < parameters; ++c) R[p][c] -= R[o][p] * R[o][c];
      }
      const double root = std::sqrt(R[p][p]);
      for (int c = p; c < parameters; ++c) R[p][c] /= root;
    }
    for (int p = 0; p < parameters; ++p) {  // s_0 = (R'R)^-1 s_0
      for (int o = 0; o < p; ++o) s_0[p] -= R[o][p] * s_0[o];
      s_0[p] /= R[p][p];
    }
    back(R, parameters, s_0);
    each_condition(m, x, parameter, parameters, size, [&](const double* row, double least) {
      SLIDEWAY_ASSUME(parameters <= n_guides);
      double g[n_guides] = {}, value = row[0], length = 0;  // value + row . (s_0 + size R^-1 z) >= least
      for (int p = 0; p < parameters; ++p) {
        value += row[p + 1] * s_0[p];
        g[p] = row[p + 1];
        for (int o = 0; o < p; ++o) g[p] -= R[o][p] * g[o];  // g R = row
        g[p] /= R[p][p];
        length += g[p] * g[p];
      }
      double right = (least > 0 ? least - value : -4 * rank_bound(source_) * size - value) / size;
      const double unit = 1 / std::sqrt(length + right * right + 0x1p-1022);
      for (int p = 0; p < parameters; ++p) g[p] *= unit;
      search.require(g, right * unit);
    });
    if (!search.solve()) return false;
    for (int p = 0; p < parameters; ++p) s[p] = search.x[p];
    back(R, parameters, s);
    for (int p = 0; p < parameters; ++p) s[p] = s_0[p] + size * s[p];
    return true;
  }

  /// x = R^-1 x
  static void back(const double (&R)[n_guides][n_guides], int n, double* x) noexcept {
    SLIDEWAY_ASSUME(n <= n_guides);
    for (int p = n - 1; p >= 0; --p) {
      for (int o = p + 1; o < n; ++o) x[p] -= R[p][o] * x[o];
      x[p] /= R[p][p];
    }
  }

  /// The weakest statement and the hardest problem count.
  void note(Report& report, Uniqueness uniqueness, int solves) const noexcept {
    report.solves = report.solves > solves ? report.solves : solves;
    report.uniqueness = report.uniqueness > uniqueness ? report.uniqueness : uniqueness;
  }

  const HlcpOptions& options_;
  int open_[n_guides], open_count_ = 0;  ///< guides whose mode is to be found
  bool fixed_[n_guides], dwells_[n_guides], jammed_ = false;
  double slack_ = 0, roundings_ = 0;
};

}  // namespace slideway
