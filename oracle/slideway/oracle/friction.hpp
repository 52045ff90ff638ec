// Which modes Coulomb's law allows at an instant, by trying every one, and which of them a right program takes.
//
// A mode is allowed if its conditions hold just after the instant: forces on the faces that it assumes, friction of
// guides at rest within its limit, guides that leave rest moving as it says. "Just after" is decided by series: the
// first coefficient that is not zero counts, so that ties (a force that vanishes, a speed that starts from zero) need
// no tolerance in time.
#pragma once

#include <optional>
#include <slideway/oracle/dynamics.hpp>
#include <utility>

namespace slideway::oracle {

/// Relative sliding speed below which a guide is at rest, in a state that comes in doubles: some thousand of their
/// roundings. Dimensionless.
inline constexpr double rest_in_doubles = 0x1p-40;

enum class Verdict {
  unique,
  motion_only,  ///< one motion, several sets of forces: one of them is given
  none,         ///< no mode is allowed
  several,      ///< several motions: one that keeps most guides at rest comes first
  unverified,   ///< more modes than are tried: one that is allowed
  undecided     ///< more modes than are tried, and none of those was allowed
};

/// Something that a mode assumes: a quantity that is >= 0 while the mode lasts.
struct Condition {
  enum Kind {
    face,  ///< contact `index` carries on the side `sign`
    slip,  ///< guide `index` slides in the direction `sign`
    hold   ///< guide `index` is held against friction in the direction `sign`
  } kind;
  int index, sign;
};

/// A mode that is allowed, with what it gives at the instant.
template <class T>
struct Solution {
  Mode mode;
  std::vector<T> acceleration;      ///< three a body
  std::vector<T> lambda, friction;  ///< of each contact, of each guide
  std::vector<bool> at_rest;        ///< rough guides that were at rest and stay so
};

template <class T>
struct Decision {
  Verdict verdict = Verdict::none;
  std::vector<Solution<T>> solutions;  ///< the one to take comes first
  Coefficients<T> mu;                  ///< to go on with in its mode
};

template <class T>
class FrictionLaw {
 public:
  static constexpr int most_modes = 4096;  ///< tried at an instant
  /// From as many signs on, those that the contacts' problem alone excludes are not tried in the whole system.
  static constexpr int many_signs = 32;
  /// Orders of the series that decide ties. What vanishes to all of them is zero for good.
  static constexpr int tie_orders = 6;
  /// Orders that the dynamics need for that.
  static constexpr int orders = tie_orders + 3;

  explicit FrictionLaw(Dynamics<T>& dynamics) : dynamics_(dynamics) {}

  /// Of each rough guide: |v| <= tolerance sum |terms of v|. `tolerance` is the relative accuracy of the speeds.
  std::vector<bool> find_at_rest(const Motion<T>& motion, const T& tolerance);

  /// All allowed modes with the given coefficients; guides that are not at rest slip as their speed says. Each solution
  /// is given once. With more than most_modes: of those with the signs that iteration finds.
  std::vector<Solution<T>> solutions(const Motion<T>& motion, const std::vector<bool>& at_rest,
                                     const Coefficients<T>& mu);

  /// What a right program takes: mu_static decides which guides leave rest, mu acts on those that do, from then on.
  /// When one has left, others may follow or it may be held after all: repeated until no guide joins. Rest is
  /// preferred.
  Decision<T> decide(const Motion<T>& motion, const std::vector<bool>& at_rest);

  /// Of a motion that was rounded to doubles. Where guides at rest outnumber the freedom, their rows and those of the
  /// constraints contradict each other by that rounding: there the law is asked of the motion moved onto the
  /// constraints, guides at rest at speed zero. Not without loads: that rounding is then all there is.
  Decision<T> decide_rounded(const Motion<T>& motion, const std::vector<bool>& at_rest);

  /// Modes of an instant, at most most_modes + 1.
  int count(const std::vector<bool>& at_rest, const Coefficients<T>& mu) const;

  /// What a mode assumes. Guides that slip from the start on do so: only those that leave rest have a condition, unless
  /// `all_slips`.
  std::vector<Condition> conditions(const Mode& mode, const std::vector<bool>& at_rest, const Coefficients<T>& mu,
                                    bool all_slips) const;
  /// Coefficient of a condition's quantity in the solution that the dynamics have.
  T value(const Condition& condition, int order) const;
  /// What it is zero beside.
  T scale(const Condition& condition, int order) const;

 private:
  bool guide_is_rough(int g) const { return dynamics_.guide(g).rough(); }
  int sign_after(const Condition& condition, bool from_rest);
  T largest_load() const;
  T push() const;
  bool same(const Solution<T>& a, const Solution<T>& b) const;
  bool is_allowed(const Mode& mode, const std::vector<bool>& at_rest, const Coefficients<T>& mu);
  Solution<T> read(const Mode& mode, const std::vector<bool>& at_rest);
  Mode first_mode(const std::vector<bool>& at_rest) const;
  using Problem = typename Dynamics<T>::ContactProblem;
  static std::optional<std::vector<T>> forces(const Problem& problem, const std::vector<int>& sign);
  static std::vector<int> signs(const std::vector<T>& x);
  static std::vector<int> iterate(const Problem& problem);
  std::vector<Mode> modes(const Mode& slips, const Coefficients<T>& mu);
  std::vector<Solution<T>> jammed(const std::vector<bool>& at_rest, const Coefficients<T>& mu);
  std::vector<Solution<T>> jammed(int given, const Mode& mode, const std::vector<bool>& at_rest,
                                  const Coefficients<T>& mu);

  Dynamics<T>& dynamics_;
};

namespace detail {

/// Equal to rounding, beside the largest of them and `size`.
template <class T>
bool close(const std::vector<T>& a, const std::vector<T>& b, T size) {
  using std::abs;
  T difference(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, T(abs(a[i] - b[i])));
    size = std::max(size, T(abs(a[i]) + abs(b[i])));
  }
  return difference <= zero_tolerance<T>() * size;
}

}  // namespace detail

template <class T>
std::vector<bool> FrictionLaw<T>::find_at_rest(const Motion<T>& motion, const T& tolerance) {
  using std::abs;
  dynamics_.begin(motion);
  std::vector<bool> at_rest;
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const auto& row = dynamics_.sliding(g);
    T size(0);  // what the row could make of the speeds in any direction: each of its terms can vanish with v
    const auto add = [&](int body, const auto& entry) {
      if (body == ground) return;
      const T* v = &motion.velocity[static_cast<std::size_t>(3 * body)];
      size += abs(v[0]) + abs(v[1]) + abs(entry[2][0] * v[2]);
    };
    add(row.a, row.on_a);
    add(row.b, row.on_b);
    at_rest.push_back(guide_is_rough(g) && abs(row.speed[0]) <= tolerance * size);
  }
  return at_rest;
}

template <class T>
int FrictionLaw<T>::count(const std::vector<bool>& at_rest, const Coefficients<T>& mu) const {
  int modes = 1;
  const auto times = [&](int n) { modes = modes > most_modes ? modes : modes * n; };
  for (int g = 0; g < dynamics_.guides(); ++g) {
    if (at_rest[static_cast<std::size_t>(g)]) times(3);
  }
  for (int g : dynamics_.mechanism.guide_of) {
    if (mu[static_cast<std::size_t>(g)] > 0) times(2);
  }
  return modes;
}

/// All faces positive, guides at rest held, the others slipping as they do.
template <class T>
Mode FrictionLaw<T>::first_mode(const std::vector<bool>& at_rest) const {
  Mode mode;
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const bool moves = guide_is_rough(g) && !at_rest[static_cast<std::size_t>(g)];
    mode.slip.push_back(!moves ? 0 : dynamics_.sliding(g).speed[0] > 0 ? 1 : -1);
  }
  mode.sign.assign(static_cast<std::size_t>(dynamics_.contacts()), 1);
  return mode;
}

template <class T>
std::vector<Condition> FrictionLaw<T>::conditions(const Mode& mode, const std::vector<bool>& at_rest,
                                                  const Coefficients<T>& mu, bool all_slips) const {
  std::vector<Condition> all;
  for (int c = 0; c < dynamics_.contacts(); ++c) {
    const auto g = static_cast<std::size_t>(dynamics_.mechanism.guide_of[static_cast<std::size_t>(c)]);
    if (mu[g] > 0) all.push_back({Condition::face, c, mode.sign[static_cast<std::size_t>(c)]});
  }
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const auto at = static_cast<std::size_t>(g);
    if (mode.slip[at] != 0 && (at_rest[at] || all_slips)) all.push_back({Condition::slip, g, mode.slip[at]});
    if (mode.slip[at] != 0 || !guide_is_rough(g)) continue;
    all.push_back({Condition::hold, g, 1});
    all.push_back({Condition::hold, g, -1});
  }
  return all;
}

template <class T>
T FrictionLaw<T>::value(const Condition& condition, int order) const {
  const T sign(condition.sign);
  if (condition.kind == Condition::face) return sign * dynamics_.lambda(condition.index, order);
  if (condition.kind == Condition::slip) return sign * dynamics_.sliding(condition.index).speed[order];
  return dynamics_.margin(condition.index, condition.sign, order);
}

/// The largest applied force, N: what forces are compared with that may all be zero.
template <class T>
T FrictionLaw<T>::largest_load() const {
  using std::abs;
  T most(0);
  for (const auto& force : dynamics_.mechanism.force) most = std::max(most, T(abs(force[0])));
  return most;
}

/// What it makes of the heaviest body, m/s^2.
template <class T>
T FrictionLaw<T>::push() const {
  T heaviest(0);
  for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); i += 3)
    heaviest = std::max(heaviest, dynamics_.mechanism.mass(i));
  return heaviest > 0 ? T(largest_load() / heaviest) : T(0);
}

/// What a coefficient is compared with: the largest force, or speed, of this order and those before (time in seconds),
/// and for speeds what the loads would make of them. At rest under constant loads all speeds and all rates of forces
/// are rounding: only the loads tell of what.
template <class T>
T FrictionLaw<T>::scale(const Condition& condition, int order) const {
  using std::abs;
  const auto& mechanism = dynamics_.mechanism;
  const bool of_slip = condition.kind == Condition::slip;
  T most = of_slip ? push() : T(0);
  const auto raise = [&](const T& x) { most = std::max(most, T(abs(x))); };
  for (int k = 0; k <= order; ++k) {
    for (int i = 0; i < 3 * mechanism.bodies(); ++i) {
      if (of_slip) {
        raise(T(k + 1) * mechanism.position(i)[k + 1]);
      } else {
        raise(mechanism.force[static_cast<std::size_t>(i)][k]);
        raise(mechanism.mass(i) * dynamics_.unknown(i, k));
      }
    }
    for (int c = 0; !of_slip && c < dynamics_.contacts(); ++c) raise(dynamics_.lambda(c, k));
  }
  return most;
}

/// Sign of a condition's quantity just after the instant; 0 if it vanishes to all orders.
template <class T>
int FrictionLaw<T>::sign_after(const Condition& condition, bool from_rest) {
  using std::abs;
  for (int order = from_rest ? 1 : 0; order <= tie_orders; ++order) {
    while (dynamics_.solved() <= order) dynamics_.extend();
    const T x = value(condition, order);
    if (abs(x) > zero_tolerance<T>() * scale(condition, order)) return x > 0 ? 1 : -1;
  }
  return 0;
}

/// Solves in the mode and examines its conditions.
template <class T>
bool FrictionLaw<T>::is_allowed(const Mode& mode, const std::vector<bool>& at_rest, const Coefficients<T>& mu) {
  if (!dynamics_.solve(mode, mu)) return false;
  const std::vector<Condition> all = conditions(mode, at_rest, mu, false);
  return std::all_of(all.begin(), all.end(),
                     [&](const Condition& c) { return sign_after(c, c.kind == Condition::slip) >= 0; });
}

/// The solution that the dynamics have. A guide that leaves rest with a speed that stays zero is at rest at its limit.
template <class T>
Solution<T> FrictionLaw<T>::read(const Mode& mode, const std::vector<bool>& at_rest) {
  Solution<T> s{mode, {}, {}, {}, at_rest};
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const auto at = static_cast<std::size_t>(g);
    s.friction.push_back(dynamics_.friction(g, 0));
    const int slip = mode.slip[at];
    if (at_rest[at] && slip != 0) s.at_rest[at] = sign_after({Condition::slip, g, slip}, true) == 0;
  }
  for (int c = 0; c < dynamics_.contacts(); ++c) {
    s.lambda.push_back(dynamics_.lambda(c, 0));
    const auto g = static_cast<std::size_t>(dynamics_.mechanism.guide_of[static_cast<std::size_t>(c)]);
    if (!(dynamics_.guide(static_cast<int>(g)).mu_static > 0) && s.lambda.back() < 0) {
      s.mode.sign[static_cast<std::size_t>(c)] = -1;
    }
  }
  for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); ++i) s.acceleration.push_back(dynamics_.unknown(i, 0));
  return s;
}

template <class T>
bool FrictionLaw<T>::same(const Solution<T>& a, const Solution<T>& b) const {
  return detail::close(a.acceleration, b.acceleration, push()) && detail::close(a.lambda, b.lambda, largest_load()) &&
         detail::close(a.friction, b.friction, largest_load());
}

/// The contacts' forces with given signs, by their own problem. Nothing if it is singular for them.
template <class T>
std::optional<std::vector<T>> FrictionLaw<T>::forces(const Problem& problem, const std::vector<int>& sign) {
  const auto n = static_cast<std::size_t>(problem.n);
  typename Elimination<T>::Rows w(n, std::vector<T>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) w[i][j] = (sign[j] > 0 ? problem.plus : problem.minus)[i * n + j];
  }
  Elimination<T> factors;
  factors.compute(std::move(w));
  if (factors.lost_rank()) return std::nullopt;
  return factors.solve(problem.b);
}

/// -1, +1, or 0 for what is rounding beside the largest.
template <class T>
std::vector<int> FrictionLaw<T>::signs(const std::vector<T>& x) {
  using std::abs;
  T most(0);
  for (const T& force : x) most = std::max(most, T(abs(force)));
  std::vector<int> sign;
  for (const T& force : x) sign.push_back(abs(force) <= zero_tolerance<T>() * most ? 0 : force > 0 ? 1 : -1);
  return sign;
}

/// Signs that the contacts' problem confirms, from all + on: those of its solution until they repeat; then, lest that
/// cycles, the first contradiction alone (finite for W-problems; Murty).
template <class T>
std::vector<int> FrictionLaw<T>::iterate(const Problem& problem) {
  constexpr int at_once = 50, most_trials = 5000;
  std::vector<int> sign(static_cast<std::size_t>(problem.n), 1);
  for (int trial = 0; trial < most_trials; ++trial) {
    const auto x = forces(problem, sign);
    if (!x) return {};
    const std::vector<int> found = signs(*x);
    bool confirmed = true;
    for (std::size_t c = 0; c < sign.size(); ++c) {
      if (found[c] * sign[c] >= 0 || (!confirmed && trial >= at_once)) continue;
      sign[c] = found[c];
      confirmed = false;
    }
    if (confirmed) return found;
  }
  return {};
}

/// The modes with given slips that are worth trying in the whole system. Few signs: all. Many: those that the contacts'
/// problem, in the same arithmetic, does not exclude. Too many: those that iteration finds, vanishing forces with both.
template <class T>
std::vector<Mode> FrictionLaw<T>::modes(const Mode& slips, const Coefficients<T>& mu) {
  std::vector<std::size_t> open;  // contacts whose sign is open
  for (std::size_t c = 0; c < slips.sign.size(); ++c) {
    if (mu[static_cast<std::size_t>(dynamics_.mechanism.guide_of[c])] > 0) open.push_back(c);
  }
  Problem problem;
  bool reduced = (1LL << open.size()) >= many_signs && dynamics_.contact_problem(slips, mu, problem);
  Mode base = slips;
  if ((1LL << open.size()) > most_modes) {
    const std::vector<int> found = reduced ? iterate(problem) : std::vector<int>();
    if (found.empty()) return {};
    open.clear();
    for (std::size_t c = 0; c < found.size(); ++c) {
      if (found[c] == 0) open.push_back(c);
      if (found[c] != 0) base.sign[c] = found[c];
    }
    reduced = false;
    if ((1LL << open.size()) > most_modes) return {};
  }
  std::vector<Mode> worth;
  for (long long number = 0; number < 1LL << open.size(); ++number) {
    Mode mode = base;
    for (std::size_t k = 0; k < open.size(); ++k) mode.sign[open[k]] = (number >> k) % 2 == 0 ? 1 : -1;
    const auto x = reduced ? forces(problem, mode.sign) : std::nullopt;
    const std::vector<int> found = x ? signs(*x) : mode.sign;
    if (std::all_of(open.begin(), open.end(), [&](std::size_t c) { return found[c] * mode.sign[c] >= 0; })) {
      worth.push_back(mode);
    }
  }
  return worth;
}

template <class T>
std::vector<Solution<T>> FrictionLaw<T>::solutions(const Motion<T>& motion, const std::vector<bool>& at_rest,
                                                   const Coefficients<T>& mu) {
  std::vector<Solution<T>> found;
  dynamics_.begin(motion);
  const auto add = [&](const Solution<T>& solution) {
    if (std::none_of(found.begin(), found.end(), [&](const auto& other) { return same(other, solution); })) {
      found.push_back(solution);
    }
  };
  int choices = 1;
  for (const bool rests : at_rest) choices *= rests && choices <= most_modes ? 3 : 1;
  if (choices > most_modes) return found;
  for (int number = 0; number < choices; ++number) {
    Mode slips = first_mode(at_rest);
    int digits = number;
    for (std::size_t g = 0; g < slips.slip.size(); ++g) {
      if (!at_rest[g]) continue;
      slips.slip[g] = digits % 3 == 2 ? -1 : digits % 3;
      digits /= 3;
    }
    for (const Mode& mode : modes(slips, mu)) {
      if (is_allowed(mode, at_rest, mu)) add(read(mode, at_rest));
    }
  }
  for (const Solution<T>& solution : jammed(at_rest, mu)) add(solution);
  return found;
}

/// All guides at rest held, where that is one more than the freedom there is: with friction of guide `given` as a
/// parameter s, all forces are affine in s, and the conditions leave an interval of s. Its finite ends, and a point
/// more if it has only one. Nothing if the freedom is not such.
template <class T>
std::vector<Solution<T>> FrictionLaw<T>::jammed(int given, const Mode& mode, const std::vector<bool>& at_rest,
                                                const Coefficients<T>& mu) {
  using std::abs;
  const auto at = static_cast<std::size_t>(given);
  Mode free = mode;
  free.slip[at] = 1;
  Coefficients<T> other = mu;
  other[at] = T(0);
  const auto solve = [&](const T& s) {
    std::vector<T> applied(mu.size(), T(0));
    applied[at] = s + dynamics_.guide(given).preload;
    return dynamics_.solve(free, other, applied);
  };
  // Everything that must be >= 0.
  const auto margins = [&] {
    std::vector<T> all;
    for (const Condition& condition : conditions(mode, at_rest, mu, false)) {
      if (condition.kind != Condition::hold || condition.index != given) {
        all.push_back(value(condition, 0));
        continue;
      }
      T limit = dynamics_.guide(given).preload - T(condition.sign) * dynamics_.friction(given, 0);
      for (int c = 0; c < dynamics_.contacts(); ++c) {
        if (dynamics_.mechanism.guide_of[static_cast<std::size_t>(c)] != given) continue;
        limit += mu[at] * T(mode.sign[static_cast<std::size_t>(c)]) * dynamics_.lambda(c, 0);
      }
      all.push_back(limit);
    }
    return all;
  };
  if (!solve(T(0)) || sign_after({Condition::slip, given, 1}, true) != 0) return {};
  const std::vector<T> start = margins();
  const T unit = std::max(T(largest_load()), T(scale({Condition::hold, given, 1}, 0)));
  if (unit == 0 || !solve(unit)) return {};
  const std::vector<T> end = margins();
  std::optional<T> low, high;  // of s / unit
  for (std::size_t i = 0; i < start.size(); ++i) {
    const T slope = end[i] - start[i];
    if (abs(slope) <= zero_tolerance<T>() * unit) {
      if (start[i] < -zero_tolerance<T>() * unit) return {};
      continue;
    }
    const T root = -start[i] / slope;
    if (slope > 0) low = low ? std::max(*low, root) : root;
    if (slope < 0) high = high ? std::min(*high, root) : root;
  }
  if (low && high && *high < *low - zero_tolerance<T>()) return {};
  std::vector<T> points;
  if (low) points.push_back(*low);
  if (high) points.push_back(*high);
  if (points.size() < 2) points.push_back(low ? T(*low + 1) : high ? T(*high - 1) : T(0));
  std::vector<Solution<T>> found;
  for (const T& point : points) {
    if (!solve(point * unit)) continue;
    found.push_back(read(free, at_rest));
    found.back().mode = mode;
    found.back().at_rest = at_rest;
  }
  return found;
}

/// Ways to hold all guides at rest that no single mode has: see above.
template <class T>
std::vector<Solution<T>> FrictionLaw<T>::jammed(const std::vector<bool>& at_rest, const Coefficients<T>& mu) {
  const Mode held = first_mode(at_rest);
  const auto rests = std::find(at_rest.begin(), at_rest.end(), true);
  if (rests == at_rest.end() || dynamics_.solve(held, mu)) return {};
  std::vector<Solution<T>> found;
  for (const Mode& mode : modes(held, mu)) {
    const auto more = jammed(static_cast<int>(rests - at_rest.begin()), mode, at_rest, mu);
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

template <class T>
Decision<T> FrictionLaw<T>::decide(const Motion<T>& motion, const std::vector<bool>& at_rest) {
  Decision<T> decision;
  for (int g = 0; g < dynamics_.guides(); ++g) {
    decision.mu.push_back(at_rest[static_cast<std::size_t>(g)] ? dynamics_.guide(g).mu_static : dynamics_.guide(g).mu);
  }
  std::vector<bool> leaving(at_rest.size(), false);
  bool several = false;
  for (bool grows = true; grows;) {
    grows = false;
    auto& found = decision.solutions;
    found = solutions(motion, at_rest, decision.mu);
    const bool complete = count(at_rest, decision.mu) <= most_modes;
    if (found.empty()) {
      decision.verdict = complete ? Verdict::none : Verdict::undecided;
      return decision;
    }
    const auto resting = [](const Solution<T>& s) { return std::count(s.at_rest.begin(), s.at_rest.end(), true); };
    std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return resting(a) > resting(b); });
    several = several || std::any_of(found.begin(), found.end(), [&](const Solution<T>& s) {
                return !detail::close(s.acceleration, found.front().acceleration, push());
              });
    decision.verdict = several            ? Verdict::several
                       : !complete        ? Verdict::unverified
                       : found.size() > 1 ? Verdict::motion_only
                                          : Verdict::unique;
    for (std::size_t g = 0; g < at_rest.size(); ++g) {
      if (!at_rest[g] || found.front().at_rest[g] || leaving[g]) continue;
      leaving[g] = grows = true;
      decision.mu[g] = dynamics_.guide(static_cast<int>(g)).mu;
    }
  }
  for (std::size_t g = 0; g < at_rest.size(); ++g) {  // held after all: mu_static decides again
    if (leaving[g] && decision.solutions.front().at_rest[g]) {
      decision.mu[g] = dynamics_.guide(static_cast<int>(g)).mu_static;
    }
  }
  return decision;
}

template <class T>
Decision<T> FrictionLaw<T>::decide_rounded(const Motion<T>& motion, const std::vector<bool>& at_rest) {
  const bool rests = std::find(at_rest.begin(), at_rest.end(), true) != at_rest.end();
  dynamics_.begin(motion);
  const Coefficients<T> none(at_rest.size(), T(0));
  if (!rests || largest_load() == 0 || dynamics_.solve(first_mode(at_rest), none)) return decide(motion, at_rest);
  Motion<T> exact = motion;
  if (!dynamics_.project(exact, std::vector<bool>(at_rest.size(), false))) return decide(motion, at_rest);
  dynamics_.begin(exact);
  const auto stopping = dynamics_.least_change(dynamics_.constraint_errors(true), at_rest);
  for (std::size_t i = 0; stopping && i < stopping->size(); ++i) exact.velocity[i] += (*stopping)[i];
  return decide(exact, at_rest);
}

extern template class FrictionLaw<Real>;

}  // namespace slideway::oracle
