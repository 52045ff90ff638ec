// One step of the kernel's methods in the oracle's arithmetic: the same formulas of step.hpp in the joints'
// coordinates, accelerations from the Cartesian KKT system, and in every stage the mode that Coulomb's law allows
// there. What a step in doubles differs from it by is rounding; what it misses the constraints by is the method's own
// defect (drift.hpp).
#pragma once

#include <slideway/oracle/friction.hpp>

namespace slideway::oracle {

/// A time with positions and speeds of the joints' coordinates, body by body: the kernel's State.
template <class T>
struct TreeState {
  T t;
  std::vector<T> q, v;
};

/// The kernel's methods that integrate, by their names there: semi-implicit Euler and classical Runge-Kutta.
enum class Scheme { euler, rk4 };
constexpr const char* name(Scheme scheme) noexcept { return scheme == Scheme::euler ? "euler" : "rk4"; }

/// What a constraint is missed by, Phi (m | rad), and its rate Phi'.
template <class T>
struct Drift {
  T position, velocity;
};

template <class T>
class Method {
 public:
  /// Relative speed below which a guide is at rest: some thousand roundings of the doubles that states come in.
  static constexpr double rest = 0x1p-40;

  /// Drives law and dynamics, made with at least FrictionLaw<T>::orders; gains are the model's.
  Method(Dynamics<T>& dynamics, FrictionLaw<T>& law) : dynamics_(dynamics), law_(law) {}

  /// `to` = the state of one step h later. A guide that the first stage holds at rest is held in all stages. `to` is
  /// meaningless if the verdict of a stage, returned at once, is `none` (or lost rank) or `several`; else the weakest
  /// is returned. Cost: euler one decision of the law, rk4 four.
  Verdict step(Scheme scheme, const TreeState<T>& from, const T& h, TreeState<T>& to);

  /// q'' at a state, by the gains; `held`: guides at rest whatever their speed says, in; those that stay at rest, out.
  Verdict accelerate(const TreeState<T>& at, std::vector<bool>& held, std::vector<T>& acceleration);

  /// Drift of every constraint at a state: drives, pins (two each, along the axes of body b), contacts.
  std::vector<Drift<T>> drift(const TreeState<T>& at);

  /// Largest |Phi| and |Phi'| as the kernel reports them: of a pin, along the world's axes.
  Drift<T> largest_drift(const TreeState<T>& at);

  Dynamics<T>& dynamics() { return dynamics_; }

  static bool goes_on(Verdict verdict) {
    return verdict != Verdict::none && verdict != Verdict::several && verdict != Verdict::undecided;
  }

 private:
  Dynamics<T>& dynamics_;
  FrictionLaw<T>& law_;
};

template <class T>
Verdict Method<T>::accelerate(const TreeState<T>& at, std::vector<bool>& held, std::vector<T>& acceleration) {
  const Motion<T> motion = dynamics_.place(at.t, at.q, at.v);
  std::vector<bool> at_rest = law_.find_at_rest(motion, T(rest));
  for (std::size_t g = 0; g < held.size(); ++g) at_rest[g] = at_rest[g] || held[g];
  const Decision<T> decision = law_.decide(motion, at_rest);
  if (!goes_on(decision.verdict)) return decision.verdict;
  const Solution<T>& solution = decision.solutions.front();
  held = solution.at_rest;
  acceleration.clear();
  for (const auto& row : dynamics_.mechanism.coordinate) {
    acceleration.push_back(row.turning[0]);
    const auto add = [&](int body, const auto& entry) {
      for (std::size_t j = 0; body != ground && j < 3; ++j) {
        acceleration.back() += entry[j][0] * solution.acceleration[static_cast<std::size_t>(3 * body) + j];
      }
    };
    add(row.a, row.on_a);
    add(row.b, row.on_b);
  }
  return decision.verdict;
}

template <class T>
Verdict Method<T>::step(Scheme scheme, const TreeState<T>& from, const T& h, TreeState<T>& to) {
  constexpr int stages = 4, halves[stages] = {0, 1, 1, 2}, weight[stages] = {1, 2, 2, 1};
  const auto add = [](std::vector<T>& x, const T& factor, const std::vector<T>& dx) {
    for (std::size_t j = 0; j < x.size(); ++j) x[j] += factor * dx[j];
  };
  std::vector<bool> held, at_rest;
  std::vector<T> a;
  TreeState<T> stage = from;
  to = from;
  to.t += h;
  Verdict weakest = Verdict::unique;
  for (int k = 0; k < stages; ++k) {
    if (k > 0) {
      const T tau = T(halves[k]) * h / 2;
      const std::vector<T> slope = stage.v;
      stage = {T(from.t + tau), from.q, from.v};
      add(stage.q, tau, slope);
      add(stage.v, tau, a);
    }
    at_rest = held;
    const Verdict verdict = accelerate(stage, at_rest, a);
    if (!goes_on(verdict)) return verdict;
    if (k == 0) held = at_rest;
    weakest = std::max(weakest, verdict);
    if (scheme == Scheme::euler) {
      add(to.v, h, a);
      add(to.q, h, to.v);
      break;
    }
    add(to.q, T(weight[k]) * h / 6, stage.v);
    add(to.v, T(weight[k]) * h / 6, a);
  }
  return weakest;
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
