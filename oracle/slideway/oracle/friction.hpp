// Which modes Coulomb's law allows at an instant, by trying every one, and which of them a right program takes.
//
// A mode is allowed if its conditions hold just after the instant: forces on the faces that it assumes, friction of
// guides at rest within its limit, guides that leave rest moving as it says. "Just after" is decided by series: the
// first coefficient that is not zero counts, so that ties (a force that vanishes, a speed that starts from zero) need
// no tolerance in time.
#pragma once

#include <slideway/oracle/dynamics.hpp>
#include <utility>

namespace slideway::oracle {

enum class Verdict {
  unique,
  motion_only,  ///< one motion, several sets of forces: one of them is given
  none,         ///< no mode is allowed
  several,      ///< several motions: one that keeps most guides at rest comes first
  unverified    ///< more modes than are tried: the one found by changing what was violated
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
  /// Orders of the series that decide ties. What vanishes to all of them is zero for good.
  static constexpr int tie_orders = 6;
  /// Orders that the dynamics need for that.
  static constexpr int orders = tie_orders + 3;

  explicit FrictionLaw(Dynamics<T>& dynamics) : dynamics_(dynamics) {}

  /// Of each rough guide: |v| <= tolerance sum |terms of v|. `tolerance` is the relative accuracy of the speeds.
  std::vector<bool> find_at_rest(const Motion<T>& motion, const T& tolerance);

  /// All allowed modes with the given coefficients; guides that are not at rest slip as their speed says. Each solution
  /// is given once. Nothing, if there are more than most_modes.
  std::vector<Solution<T>> solutions(const Motion<T>& motion, const std::vector<bool>& at_rest,
                                     const Coefficients<T>& mu);

  /// What a right program takes: mu_static decides which guides leave rest, mu acts on those that do, from then on.
  /// When one has left, others may follow or it may be held after all: repeated until no guide joins. Rest is
  /// preferred. `guess` is where the search starts if there are too many modes to try.
  Decision<T> decide(const Motion<T>& motion, const std::vector<bool>& at_rest, const Mode& guess);

  /// Modes of an instant, at most most_modes + 1.
  int count(const std::vector<bool>& at_rest, const Coefficients<T>& mu) const;

  /// What a mode assumes. Guides that slip from the start on do so: only those that leave rest have a condition, unless
  /// `all_slips`.
  std::vector<Condition> conditions(const Mode& mode, const std::vector<bool>& at_rest, const Coefficients<T>& mu,
                                    bool all_slips) const;
  /// Coefficient of a condition's quantity in the solution that the dynamics have.
  T value(const Condition& condition, int order) const;

 private:
  bool guide_is_rough(int g) const { return dynamics_.guide(g).rough(); }
  int sign_after(const Condition& condition, bool from_rest);
  T scale(const Condition& condition, int order) const;
  bool is_allowed(const Mode& mode, const std::vector<bool>& at_rest, const Coefficients<T>& mu,
                  std::vector<Condition>* violated);
  Solution<T> read(const Mode& mode, const std::vector<bool>& at_rest);
  bool search(const std::vector<bool>& at_rest, const Coefficients<T>& mu, Mode mode, std::vector<Solution<T>>& found);
  Mode first_mode(const std::vector<bool>& at_rest) const;

  Dynamics<T>& dynamics_;
};

namespace detail {

template <class T>
bool close(const std::vector<T>& a, const std::vector<T>& b) {
  using std::abs;
  T difference(0), size(0);
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
    T size(0);
    for (std::size_t j = 0; j < 3; ++j) {
      const auto term = [&](int body, const auto& entry) {
        return body == ground ? T(0) : T(abs(entry[j][0] * motion.velocity[static_cast<std::size_t>(3 * body) + j]));
      };
      size += term(row.a, row.on_a) + term(row.b, row.on_b);
    }
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

/// What a coefficient is compared with: the largest force, or speed, of the same order.
template <class T>
T FrictionLaw<T>::scale(const Condition& condition, int order) const {
  using std::abs;
  T most(0);
  const int bodies = 3 * dynamics_.mechanism.bodies();
  for (int i = 0; i < bodies; ++i) {
    const auto raise = [&](const T& x) { most = std::max(most, T(abs(x))); };
    if (condition.kind == Condition::slip) {
      raise(T(order + 1) * dynamics_.mechanism.position(i)[order + 1]);
    } else {
      raise(dynamics_.mechanism.force[static_cast<std::size_t>(i)][order]);
      raise(dynamics_.mechanism.mass(i) * dynamics_.unknown(i, order));
    }
  }
  if (condition.kind == Condition::slip) return most;
  for (int c = 0; c < dynamics_.contacts(); ++c) most = std::max(most, T(abs(dynamics_.lambda(c, order))));
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

/// Solves in the mode and examines its conditions: all of them if `violated` is asked for, else up to the first that
/// fails.
template <class T>
bool FrictionLaw<T>::is_allowed(const Mode& mode, const std::vector<bool>& at_rest, const Coefficients<T>& mu,
                                std::vector<Condition>* violated) {
  if (!dynamics_.solve(mode, mu)) return false;
  bool allowed = true;
  for (const Condition& condition : conditions(mode, at_rest, mu, false)) {
    if (sign_after(condition, condition.kind == Condition::slip) >= 0) continue;
    allowed = false;
    if (violated == nullptr) return false;
    violated->push_back(condition);
  }
  return allowed;
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
std::vector<Solution<T>> FrictionLaw<T>::solutions(const Motion<T>& motion, const std::vector<bool>& at_rest,
                                                   const Coefficients<T>& mu) {
  std::vector<Solution<T>> found;
  dynamics_.begin(motion);
  const int modes = count(at_rest, mu);
  if (modes > most_modes) return found;
  for (int number = 0; number < modes; ++number) {
    Mode mode = first_mode(at_rest);
    int digits = number;
    for (std::size_t g = 0; g < mode.slip.size(); ++g) {
      if (!at_rest[g]) continue;
      mode.slip[g] = digits % 3 == 2 ? -1 : digits % 3;
      digits /= 3;
    }
    for (std::size_t c = 0; c < mode.sign.size(); ++c) {
      if (!(mu[static_cast<std::size_t>(dynamics_.mechanism.guide_of[c])] > 0)) continue;
      mode.sign[c] = digits % 2 == 0 ? 1 : -1;
      digits /= 2;
    }
    if (!is_allowed(mode, at_rest, mu, nullptr)) continue;
    const Solution<T> solution = read(mode, at_rest);
    const bool known = std::any_of(found.begin(), found.end(), [&](const Solution<T>& other) {
      return detail::close(other.acceleration, solution.acceleration) && detail::close(other.lambda, solution.lambda) &&
             detail::close(other.friction, solution.friction);
    });
    if (!known) found.push_back(solution);
  }
  return found;
}

/// From a mode to an allowed one, by changing what it assumes wrongly. May fail though there is one.
template <class T>
bool FrictionLaw<T>::search(const std::vector<bool>& at_rest, const Coefficients<T>& mu, Mode mode,
                            std::vector<Solution<T>>& found) {
  constexpr int most_trials = 256;
  for (int trial = 0; trial < most_trials; ++trial) {
    std::vector<Condition> violated;
    if (is_allowed(mode, at_rest, mu, &violated)) {
      found.push_back(read(mode, at_rest));
      return true;
    }
    if (violated.empty()) return false;                // singular
    if (trial >= most_trials / 2) violated.resize(1);  // least-index: slow, but it does not cycle on W-problems
    for (const Condition& condition : violated) {
      const auto i = static_cast<std::size_t>(condition.index);
      if (condition.kind == Condition::face) mode.sign[i] = -mode.sign[i];
      if (condition.kind == Condition::slip) mode.slip[i] = 0;
      if (condition.kind == Condition::hold) mode.slip[i] = -condition.sign;
    }
  }
  return false;
}

template <class T>
Decision<T> FrictionLaw<T>::decide(const Motion<T>& motion, const std::vector<bool>& at_rest, const Mode& guess) {
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
    if (!complete) {
      Mode mode = first_mode(at_rest);
      if (!guess.sign.empty()) mode.sign = guess.sign;
      search(at_rest, decision.mu, mode, found);
    }
    if (found.empty()) {
      decision.verdict = Verdict::none;
      return decision;
    }
    const auto resting = [](const Solution<T>& s) { return std::count(s.at_rest.begin(), s.at_rest.end(), true); };
    std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return resting(a) > resting(b); });
    several = several || std::any_of(found.begin(), found.end(), [&](const Solution<T>& s) {
                return !detail::close(s.acceleration, found.front().acceleration);
              });
    decision.verdict = !complete          ? Verdict::unverified
                       : several          ? Verdict::several
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

extern template class FrictionLaw<Real>;

}  // namespace slideway::oracle
