// One step of the kernel's methods in the oracle's arithmetic: the same formulas of step.hpp in the joints'
// coordinates, accelerations from the Cartesian KKT system, and in every stage the mode that Coulomb's law allows
// there, or, by the located methods, that of the first stage. What a step in doubles differs from it by is rounding;
// what it misses the constraints by is the method's own defect (drift.hpp).
#pragma once

#include <optional>
#include <slideway/method.hpp>
#include <slideway/oracle/dormand_prince.hpp>
#include <slideway/oracle/friction.hpp>

namespace slideway::oracle {

/// A time with positions and speeds of the joints' coordinates, body by body: the kernel's State.
template <class T>
struct TreeState {
  T t;
  std::vector<T> q, v;
  std::vector<bool> rests{};  ///< guides at rest whatever their speed says; none are named: their speeds alone tell
};

/// The kernel's methods that integrate, by their names there. Of the located ones: steps in which no event is.
enum class Scheme { euler, rk4, rk4_located, dop853_located };
constexpr slideway::Method method_of(Scheme scheme) noexcept {
  return scheme == Scheme::euler         ? slideway::Method::euler
         : scheme == Scheme::rk4         ? slideway::Method::rk4
         : scheme == Scheme::rk4_located ? slideway::Method::rk4_located
                                         : slideway::Method::dop853_located;
}
constexpr const char* name(Scheme scheme) noexcept { return slideway::name(method_of(scheme)); }

/// Stage k of an explicit Runge-Kutta method is at y + h sum_j a_kj f_j, its step y + h sum_k b_k f_k.
template <class T>
struct RungeKutta {
  std::vector<std::vector<T>> a;
  std::vector<T> b;
  /// sum |b_k|: what errors of the accelerations, h times, may make in v+.
  T weight() const {
    using std::abs;
    T sum(0);
    for (const T& x : b) sum += abs(x);
    return sum;
  }
};

/// Of a scheme; of euler, as far as accelerations go.
template <class T>
RungeKutta<T> runge_kutta(Scheme scheme) {
  if (scheme == Scheme::euler) return {{{}}, {T(1)}};
  if (scheme != Scheme::dop853_located) {
    const T half = T(1) / 2, third = T(1) / 3;
    return {{{}, {half}, {T(0), half}, {T(0), T(0), T(1)}}, {T(third / 2), third, third, T(third / 2)}};
  }
  std::vector<std::vector<T>> rows;
  for (int k = 0; k <= dormand_prince_stages; ++k) rows.emplace_back(static_cast<std::size_t>(k), T(0));
  for (const ButcherEntry& entry : dormand_prince) {
    rows[static_cast<std::size_t>(entry.k)][static_cast<std::size_t>(entry.j)] = T(entry.value);
  }
  const std::vector<T> step = rows.back();
  rows.pop_back();
  return {rows, step};
}

/// What a constraint is missed by, Phi (m | rad), and its rate Phi'.
template <class T>
struct Drift {
  T position, velocity;
};

template <class T>
class Method {
 public:
  /// Drives law and dynamics, made with at least FrictionLaw<T>::orders; gains are the model's.
  Method(Dynamics<T>& dynamics, FrictionLaw<T>& law) : dynamics_(dynamics), law_(law) {}

  bool projects = false;  ///< after each step onto the constraints, as the kernel's Stabilise::projection

  /// `to` = the state of one step h later. A guide that the first stage holds at rest keeps the law at rest in all
  /// stages. `to` is meaningless if the verdict of a stage, returned at once, is `none` (or lost rank) or `several`;
  /// else the weakest is returned. Cost: euler one decision of the law, rk4 four and one where guides are arrested, the
  /// located ones one and a linear solve a stage.
  Verdict step(Scheme scheme, const TreeState<T>& from, const T& h, TreeState<T>& to);

  /// q'' at a state, by the gains; `held`: guides at rest whatever their speed says, in; those that stay at rest, out.
  Verdict accelerate(const TreeState<T>& at, std::vector<bool>& held, std::vector<T>& acceleration);

  /// At a state, Dynamics::load of every body's coordinates. Nothing where the law has no or several answers.
  std::optional<std::vector<T>> loads(const TreeState<T>& at);

  /// Drift of every constraint at a state: drives, pins (two each, along the axes of body b), contacts.
  std::vector<Drift<T>> drift(const TreeState<T>& at);

  /// Largest |Phi| and |Phi'| as the kernel reports them: of a pin, along the world's axes.
  Drift<T> largest_drift(const TreeState<T>& at);

  Dynamics<T>& dynamics() { return dynamics_; }

  static bool goes_on(Verdict verdict) {
    return verdict != Verdict::none && verdict != Verdict::several && verdict != Verdict::undecided;
  }

 private:
  /// What a step has been through.
  struct Course {
    std::vector<int> first;    ///< slip of each guide in the first stage; 0 at rest
    std::vector<bool> rests;   ///< at rest in the last stage
    std::vector<T> low, high;  ///< sliding speeds, over the stages, m/s
    std::vector<T> reach;      ///< h times the first stage's accelerations
    Decision<T> decision;      ///< of the first stage
    Verdict weakest = Verdict::unique;
  };

  Verdict decide(const TreeState<T>& at, const std::vector<bool>& at_rest, Decision<T>& decision,
                 std::vector<T>& acceleration);
  Verdict begin(const TreeState<T>& at, Course& course, std::vector<T>& acceleration);
  Verdict go_on(Scheme scheme, const TreeState<T>& at, Course& course, std::vector<T>& acceleration);
  Verdict take_stages(Scheme scheme, const TreeState<T>& from, const T& h, Course& course, TreeState<T>& to);
  bool follow(const TreeState<T>& at, const Decision<T>& decision, std::vector<T>& acceleration);
  std::vector<T> with_turning(std::vector<T> acceleration) const;
  std::vector<T> sliding_speeds(const TreeState<T>& at);
  std::vector<bool> stopping(Scheme scheme, const Course& course, const std::vector<T>& speed) const;
  bool stop(const std::vector<bool>& stops, const std::vector<T>& reach, TreeState<T>& to);
  void arrest(Scheme scheme, Course& course, TreeState<T>& to);
  bool project(TreeState<T>& to, const std::vector<bool>& at_rest);

  static void add(std::vector<T>& x, const T& factor, const std::vector<T>& dx) {
    for (std::size_t j = 0; j < x.size(); ++j) x[j] += factor * dx[j];
  }

  Dynamics<T>& dynamics_;
  FrictionLaw<T>& law_;
};

/// Second derivatives of the joints' coordinates, at the motion that the dynamics have.
template <class T>
std::vector<T> Method<T>::with_turning(std::vector<T> acceleration) const {
  std::vector<T> a = dynamics_.in_joints(acceleration);
  for (std::size_t j = 0; j < a.size(); ++j) a[j] += dynamics_.mechanism.coordinate[j].turning[0];
  return a;
}

template <class T>
Verdict Method<T>::decide(const TreeState<T>& at, const std::vector<bool>& at_rest, Decision<T>& decision,
                          std::vector<T>& acceleration) {
  decision = law_.decide_rounded(dynamics_.place(at.t, at.q, at.v), at_rest);
  if (goes_on(decision.verdict)) acceleration = with_turning(decision.solutions.front().acceleration);
  return decision.verdict;
}

template <class T>
Verdict Method<T>::accelerate(const TreeState<T>& at, std::vector<bool>& held, std::vector<T>& acceleration) {
  std::vector<bool> at_rest = law_.find_at_rest(dynamics_.place(at.t, at.q, at.v), T(rest_in_doubles));
  for (std::size_t g = 0; g < held.size(); ++g) at_rest[g] = at_rest[g] || held[g];
  Decision<T> decision;
  const Verdict verdict = decide(at, at_rest, decision, acceleration);
  if (goes_on(verdict)) held = decision.solutions.front().at_rest;
  return verdict;
}

template <class T>
std::optional<std::vector<T>> Method<T>::loads(const TreeState<T>& at) {
  std::vector<bool> at_rest = law_.find_at_rest(dynamics_.place(at.t, at.q, at.v), T(rest_in_doubles));
  for (std::size_t g = 0; g < at.rests.size(); ++g) at_rest[g] = at_rest[g] || at.rests[g];
  Decision<T> decision;
  std::vector<T> acceleration, sum;
  if (!goes_on(decide(at, at_rest, decision, acceleration)) || !follow(at, decision, acceleration)) return std::nullopt;
  for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); ++i) sum.push_back(dynamics_.load(i));
  return sum;
}

/// The accelerations in the mode of a decision, whether or not it is allowed here. Where forces are a choice, the first
/// of its modes that has some. False if there is none.
template <class T>
bool Method<T>::follow(const TreeState<T>& at, const Decision<T>& decision, std::vector<T>& acceleration) {
  dynamics_.begin(dynamics_.place(at.t, at.q, at.v));
  for (const Solution<T>& solution : decision.solutions) {
    if (solution.at_rest != decision.solutions.front().at_rest || !dynamics_.solve(solution.mode, decision.mu))
      continue;
    std::vector<T> a;
    for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); ++i) a.push_back(dynamics_.unknown(i, 0));
    acceleration = with_turning(a);
    return true;
  }
  return false;
}

template <class T>
std::vector<T> Method<T>::sliding_speeds(const TreeState<T>& at) {
  dynamics_.begin(dynamics_.place(at.t, at.q, at.v));
  std::vector<T> speeds;
  for (int g = 0; g < dynamics_.guides(); ++g) speeds.push_back(dynamics_.sliding(g).speed[0]);
  return speeds;
}

/// The first stage.
template <class T>
Verdict Method<T>::begin(const TreeState<T>& at, Course& course, std::vector<T>& acceleration) {
  std::vector<bool> at_rest = law_.find_at_rest(dynamics_.place(at.t, at.q, at.v), T(rest_in_doubles));
  for (std::size_t g = 0; g < at.rests.size(); ++g) at_rest[g] = at_rest[g] || at.rests[g];
  const Verdict verdict = course.weakest = decide(at, at_rest, course.decision, acceleration);
  if (!goes_on(verdict)) return verdict;
  const Solution<T>& solution = course.decision.solutions.front();
  course.rests = solution.at_rest;
  course.low = course.high = sliding_speeds(at);
  for (std::size_t g = 0; g < course.rests.size(); ++g) {
    course.first.push_back(course.rests[g] ? 0 : solution.mode.slip[g]);
  }
  return verdict;
}

/// Another stage.
template <class T>
Verdict Method<T>::go_on(Scheme scheme, const TreeState<T>& at, Course& course, std::vector<T>& acceleration) {
  if (is_located(method_of(scheme))) {
    return follow(at, course.decision, acceleration) ? course.weakest : Verdict::none;
  }
  std::vector<bool> at_rest = course.decision.solutions.front().at_rest;
  const std::vector<T> speed = sliding_speeds(at);
  Decision<T> decision;
  const Verdict verdict = decide(at, at_rest, decision, acceleration);
  if (!goes_on(verdict)) return verdict;
  course.rests = decision.solutions.front().at_rest;
  for (std::size_t g = 0; g < speed.size(); ++g) {
    course.low[g] = std::min(course.low[g], speed[g]);
    course.high[g] = std::max(course.high[g], speed[g]);
  }
  course.weakest = std::max(course.weakest, verdict);
  return verdict;
}

template <class T>
Verdict Method<T>::take_stages(Scheme scheme, const TreeState<T>& from, const T& h, Course& course, TreeState<T>& to) {
  std::vector<std::vector<T>> v{from.v}, a(1);
  const Verdict begun = begin(from, course, a[0]);
  if (!goes_on(begun)) return begun;
  course.reach.assign(a[0].size(), T(0));
  add(course.reach, h, a[0]);
  if (scheme == Scheme::euler) {  // semi-implicit
    add(to.v, h, a[0]);
    add(to.q, h, to.v);
    return begun;
  }
  const RungeKutta<T> method = runge_kutta<T>(scheme);
  for (std::size_t k = 1; k < method.b.size(); ++k) {
    TreeState<T> stage = from;
    for (std::size_t j = 0; j < k; ++j) {
      stage.t += h * method.a[k][j];
      add(stage.q, T(h * method.a[k][j]), v[j]);
      add(stage.v, T(h * method.a[k][j]), a[j]);
    }
    v.push_back(stage.v);
    a.emplace_back();
    const Verdict verdict = go_on(scheme, stage, course, a[k]);
    if (!goes_on(verdict)) return verdict;
  }
  for (std::size_t k = 0; k < method.b.size(); ++k) {
    add(to.q, T(h * method.b[k]), v[k]);
    add(to.v, T(h * method.b[k]), a[k]);
  }
  return course.weakest;
}

/// Guides that slipped in the first stage and whose speed has changed its sign, in a stage or at the end. By rk4 none
/// if no such speed comes as near to zero as it varies within the stages.
template <class T>
std::vector<bool> Method<T>::stopping(Scheme scheme, const Course& course, const std::vector<T>& speed) const {
  std::vector<bool> stops(course.first.size(), false);
  bool near = scheme == Scheme::euler;
  for (std::size_t g = 0; g < stops.size(); ++g) {
    if (course.first[g] == 0) continue;
    const T range = course.high[g] - course.low[g];
    near = near || (course.low[g] - range <= 0 && course.high[g] + range >= 0);
    const bool crossed = scheme != Scheme::euler && course.low[g] <= 0 && course.high[g] >= 0;
    stops[g] = crossed || T(course.first[g]) * speed[g] <= 0;
  }
  if (!near) stops.assign(stops.size(), false);
  return stops;
}

/// Takes the sliding speeds of some guides away and leaves the rates of all constraints, if that changes v by no more
/// than twice `reach`, of undriven speeds, in the mass metric. False, and nothing done, if not.
template <class T>
bool Method<T>::stop(const std::vector<bool>& stops, const std::vector<T>& reach, TreeState<T>& to) {
  std::vector<T> undriven = reach;
  const auto& mechanism = dynamics_.mechanism;
  for (const auto& drive : mechanism.model.drive) {
    const int j = mechanism.first_coordinate[static_cast<std::size_t>(drive.body)] + drive.axis;
    undriven[static_cast<std::size_t>(j)] = 0;
  }
  const T most = 2 * dynamics_.size(dynamics_.place(to.t, to.q, undriven).velocity);
  dynamics_.begin(dynamics_.place(to.t, to.q, to.v));
  const std::vector<T> errors(dynamics_.constraint_errors(true).size(), T(0));
  const auto change = dynamics_.least_change(errors, stops);
  if (!change || dynamics_.size(*change) > most) return false;
  add(to.v, T(1), dynamics_.in_joints(*change));
  return true;
}

/// At the end of a step: of the guides whose speed has changed its sign within it, those that stick there with that
/// speed at zero, by the law at rest, lose it.
template <class T>
void Method<T>::arrest(Scheme scheme, Course& course, TreeState<T>& to) {
  std::vector<bool> stops = stopping(scheme, course, sliding_speeds(to));
  const auto any = [&] { return std::find(stops.begin(), stops.end(), true) != stops.end(); };
  TreeState<T> held = to;
  if (!any() || !stop(stops, course.reach, held)) return;
  std::vector<bool> at_rest = course.rests;
  for (std::size_t g = 0; g < stops.size(); ++g) at_rest[g] = at_rest[g] || stops[g];
  Decision<T> decision;
  std::vector<T> acceleration;
  if (!goes_on(decide(held, at_rest, decision, acceleration))) return;
  bool all = true;
  for (std::size_t g = 0; g < stops.size(); ++g) {
    if (!stops[g]) continue;
    stops[g] = decision.solutions.front().at_rest[g];
    course.rests[g] = stops[g];
    all = all && stops[g];
  }
  if (all) to = held;
  if (!all && any()) stop(stops, course.reach, to);
}

/// Newton's steps from the tree's coordinates: drives are put on their laws, the others moved by the least change.
template <class T>
bool Method<T>::project(TreeState<T>& to, const std::vector<bool>& at_rest) {
  using std::abs;
  const auto& mechanism = dynamics_.mechanism;
  const auto place = [&] { dynamics_.begin(dynamics_.place(to.t, to.q, to.v)); };
  place();
  for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
    const auto& drive = mechanism.model.drive[d];
    const int j = mechanism.first_coordinate[static_cast<std::size_t>(drive.body)] + drive.axis;
    to.q[static_cast<std::size_t>(j)] = mechanism.law[d][0];
    to.v[static_cast<std::size_t>(j)] = mechanism.law[d][1];
  }
  constexpr int most_steps = 16;
  const std::vector<bool> none(static_cast<std::size_t>(dynamics_.guides()), false);
  for (int step = 0; step < most_steps; ++step) {
    place();
    const std::vector<T> errors = dynamics_.constraint_errors(false);
    const bool met = std::all_of(errors.begin(), errors.end(), [](const T& e) { return abs(e) < zero_tolerance<T>(); });
    const auto change =
        met ? dynamics_.least_change(dynamics_.constraint_errors(true), at_rest) : dynamics_.least_change(errors, none);
    if (!change) return false;
    add(met ? to.v : to.q, T(1), dynamics_.in_joints(*change));
    if (met) return true;
  }
  return false;
}

template <class T>
Verdict Method<T>::step(Scheme scheme, const TreeState<T>& from, const T& h, TreeState<T>& to) {
  to = {T(from.t + h), from.q, from.v};
  Course course;
  const Verdict verdict = take_stages(scheme, from, h, course, to);
  if (!goes_on(verdict)) return verdict;
  if (!is_located(method_of(scheme))) arrest(scheme, course, to);
  if (projects && !project(to, course.rests)) return Verdict::none;
  to.rests = course.rests;
  return verdict;
}

template <class T>
std::vector<Drift<T>> Method<T>::drift(const TreeState<T>& at) {
  const auto& mechanism = dynamics_.mechanism;
  dynamics_.begin(dynamics_.place(at.t, at.q, at.v));
  std::vector<Drift<T>> all;
  for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
    const auto& row = mechanism.driven(static_cast<int>(d));
    const auto& law = mechanism.law[d];
    all.push_back({T(row.value[0] - law[0]), T(row.speed[0] - law[1])});
  }
  for (const auto& row : mechanism.pin) all.push_back({row.value[0], row.speed[0]});
  for (const auto& row : mechanism.normal) all.push_back({row.value[0], row.speed[0]});
  return all;
}

template <class T>
Drift<T> Method<T>::largest_drift(const TreeState<T>& at) {
  using std::abs;
  const auto& mechanism = dynamics_.mechanism;
  std::vector<Drift<T>> all = drift(at);
  for (std::size_t p = 0, row = mechanism.law.size(); p < mechanism.model.pin.size(); ++p, row += 2) {
    const int b = mechanism.model.pin[p].b;
    if (b == ground) continue;
    const T c = mechanism.turn(b).cosine[0], s = mechanism.turn(b).sine[0];
    const Drift<T> x = all[row], y = all[row + 1];
    all[row] = {T(c * x.position - s * y.position), T(c * x.velocity - s * y.velocity)};
    all[row + 1] = {T(s * x.position + c * y.position), T(s * x.velocity + c * y.velocity)};
  }
  Drift<T> most{T(0), T(0)};
  for (const Drift<T>& e : all) {
    most = {std::max(most.position, T(abs(e.position))), std::max(most.velocity, T(abs(e.velocity)))};
  }
  return most;
}

extern template class Method<Real>;

}  // namespace slideway::oracle
