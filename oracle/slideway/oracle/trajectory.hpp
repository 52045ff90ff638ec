// A mechanism's motion by Taylor series: inside a mode as many orders as the digits ask for, events located as roots of
// the series, the mode after each decided by friction.hpp.
//
// Step and order follow Jorba and Zou, A software package for the numerical integration of ODEs by means of
// high-order Taylor methods, Experimental Mathematics 14 (2005): for a truncation of 10^-d the order is (d ln 10) / 2,
// the step exp(-2) of the radius of convergence that the last coefficients show.
#pragma once

#include <functional>
#include <slideway/oracle/friction.hpp>
#include <slideway/oracle/roots.hpp>
#include <slideway/state.hpp>
#include <string>

namespace slideway::oracle {

template <class T>
struct TrajectoryEvent {
  T t;
  int guide, contact;  ///< contact: counted over all guides; none for what the whole guide does
  EventKind kind;
};

/// Everything at one time; just after it, if an event is there. Orders and signs as in slideway::Reaction.
template <class T>
struct Instant {
  T t;
  std::vector<T> q, v, acceleration;                  ///< of the joints' coordinates
  std::vector<T> lambda, friction, slip, drive, pin;  ///< pin: two each, world's frame
  T energy, work, dissipated;                         ///< J; the flows since the start
  T kinetic;                                          ///< J
  Mode mode;                                          ///< slip 0: at rest
  bool chosen;  ///< guides at rest outnumber the freedom: these forces are one of several sets for the same motion
};

/// Why a trajectory ended.
enum class End { duration, no_solution, not_unique, undecided, singular, too_many_events, start_off_constraints };

template <class T>
struct Trajectory {
  std::vector<Instant<T>> samples;
  std::vector<TrajectoryEvent<T>> events;
  End end = End::duration;
  T t{};                    ///< reached
  T energy_miss{};          ///< largest |energy - start - work + dissipated|, over the largest of them
  bool unverified = false;  ///< somewhere there were too many modes to try them all
  long steps = 0;
};

struct TrajectoryOptions {
  int digits = 36;  ///< of truncation, relative to each step
  double step = 1;  ///< factor on the step: a second run with another one must agree
  int most_events = 100000;
  std::function<void(double)> progress = [](double) {};  ///< called with the time reached
};

template <class T>
class Integrator {
 public:
  Integrator(const Model<T>& model, const TrajectoryOptions& options)
      : options_(options), order_(order_for(options.digits)), dynamics_(model, order_ + 2), law_(dynamics_) {
    dynamics_.rest_gain = T(0);  // no speed is left here, and exp(-alpha t) of rounding would cost digits
  }

  /// From the model's start, moved onto the constraints, over `duration`; `times` ascend within it.
  Trajectory<T> run(const T& duration, const std::vector<T>& times);

  Dynamics<T>& dynamics() { return dynamics_; }

 private:
  static int order_for(int digits) {
    return std::max(FrictionLaw<T>::orders, static_cast<int>(std::ceil(std::max(digits, 34) * std::log(10.0) / 2)));
  }

  bool begin();
  bool decide();
  void expand();
  T step_size() const;
  std::optional<T> first_event(const T& h) const;
  Motion<T> motion_at(const T& tau) const;
  Instant<T> instant(const T& tau) const;
  void expand_powers();
  void take_events(const Mode& before);
  void find_rest(const T& tau);
  Mode shown_mode() const;
  T at(const typename Tape<T>::Node& node, const T& tau, int last) const;
  T rate_at(const typename Tape<T>::Node& node, const T& tau, int last) const;
  T unknown_at(int unknown, const T& tau) const;
  T integral(const std::vector<T>& power, const T& tau) const;

  TrajectoryOptions options_;
  int order_;  ///< of the accelerations and forces
  Dynamics<T> dynamics_;
  FrictionLaw<T> law_;

  Motion<T> motion_;
  std::vector<bool> at_rest_;  ///< guides
  Mode mode_;                  ///< of the law: a guide at rest at its limit has a slip
  bool chosen_ = false;        ///< forces are a choice
  Coefficients<T> mu_;
  T work_{}, dissipated_{};
  std::vector<T> work_power_, dissipated_power_;  ///< series
  Trajectory<T> result_;
};

template <class T>
Trajectory<T> Integrator<T>::run(const T& duration, const std::vector<T>& times) {
  using std::abs;
  result_ = {};
  work_ = dissipated_ = T(0);
  if (!begin()) return result_;
  constexpr int most_standing = 100;  // decisions at one time: each takes a guide or contact on, and none comes back
  int standing = 0;
  std::size_t next = 0;
  T energy_start(0), energy_most(0);
  while (true) {
    if (!dynamics_.solve(mode_, mu_)) {
      result_.end = End::singular;
      break;
    }
    expand();
    const T left = duration - motion_.t;
    const T h = std::min(left, step_size());
    const auto event = first_event(h);
    const T tau = event ? *event : h;
    for (; next < times.size() && times[next] < motion_.t + tau; ++next) {
      result_.samples.push_back(instant(T(times[next] - motion_.t)));
    }
    const Instant<T> end = instant(tau);
    if (result_.steps == 0) energy_start = instant(T(0)).energy;
    energy_most = std::max(energy_most, T(abs(end.energy) + abs(end.work) + abs(end.dissipated)));
    const T miss = abs(T(end.energy - energy_start - end.work + end.dissipated));
    if (miss > result_.energy_miss * energy_most) result_.energy_miss = miss / energy_most;
    work_ = end.work;
    dissipated_ = end.dissipated;
    const Mode before = shown_mode();
    if (event) find_rest(tau);
    motion_ = motion_at(tau);
    ++result_.steps;
    standing = tau > 0 ? 0 : standing + 1;
    result_.t = motion_.t;
    options_.progress(static_cast<double>(motion_.t));
    const bool done = motion_.t >= duration;
    if (event) {
      if (static_cast<int>(result_.events.size()) > options_.most_events || standing > most_standing) {
        result_.end = End::too_many_events;
        break;
      }
      if (!decide()) break;
      take_events(before);
    }
    if (done) {
      for (; next < times.size(); ++next) result_.samples.push_back(end);
      break;
    }
    dynamics_.begin(motion_);
  }
  return result_;
}

template <class T>
bool Integrator<T>::begin() {
  const Model<T>& model = dynamics_.mechanism.model;
  motion_ = dynamics_.place(T(0), model.start.q, model.start.v);
  at_rest_ = law_.find_at_rest(motion_, T(rest_in_doubles));
  if (!dynamics_.project(motion_, at_rest_)) {
    result_.end = End::start_off_constraints;
    return false;
  }
  mode_ = {};
  return decide();
}

/// The mode at motion_, and the series begun there.
template <class T>
bool Integrator<T>::decide() {
  Decision<T> decision = law_.decide(motion_, at_rest_);
  result_.unverified = result_.unverified || decision.verdict == Verdict::unverified;
  if (decision.verdict == Verdict::none) result_.end = End::no_solution;
  if (decision.verdict == Verdict::several) result_.end = End::not_unique;
  if (decision.verdict == Verdict::undecided) result_.end = End::undecided;
  if (result_.end != End::duration) return false;
  mode_ = decision.solutions.front().mode;
  chosen_ = decision.verdict == Verdict::motion_only;
  at_rest_ = decision.solutions.front().at_rest;
  mu_ = decision.mu;
  dynamics_.begin(motion_);
  return true;
}

template <class T>
void Integrator<T>::expand() {
  while (dynamics_.solved() < order_) dynamics_.extend();
  dynamics_.extend_positions();
  expand_powers();
}

/// exp(-2) of the radius of convergence, estimated from the last two coefficients of accelerations and forces, and of
/// the powers and the potential: of products, whose series are longer.
template <class T>
T Integrator<T>::step_size() const {
  using std::abs, std::exp, std::pow;
  const auto forces = [&](int order) {
    T most(0);
    for (int i = 0; i < dynamics_.unknown_of_contact(dynamics_.contacts()); ++i) {
      most = std::max(most, T(abs(dynamics_.unknown(i, order))));
    }
    return most;
  };
  const auto powers = [&](int order) {
    const auto k = static_cast<std::size_t>(order);
    return T(abs(work_power_[k]) + abs(dissipated_power_[k]) + abs(dynamics_.mechanism.potential[order]));
  };
  // Of the last ten: series of even or odd functions, or of t^4, have zeros among them.
  constexpr int last_orders = 10;
  T radius = std::numeric_limits<T>::max();
  const auto lower = [&](const auto& size) {
    int first = 0;
    while (first < order_ - last_orders && size(first) == 0) ++first;
    const T unit = std::max({size(first), size(first + 1), size(first + 2)});
    for (int order = order_ - last_orders; order < order_; ++order) {
      const T last = size(order);
      if (last > 0 && unit > 0) radius = std::min(radius, T(pow(T(unit / last), T(1) / (order - first))));
    }
  };
  lower(forces);
  lower(powers);
  return T(options_.step) * exp(T(-2)) * radius;
}

template <class T>
std::optional<T> Integrator<T>::first_event(const T& h) const {
  std::optional<T> first;
  for (const Condition& condition : law_.conditions(mode_, at_rest_, mu_, true)) {
    if (condition.kind == Condition::slip && at_rest_[static_cast<std::size_t>(condition.index)]) continue;
    std::vector<T> scaled;
    T power(1);
    for (int k = 0; k < order_; ++k, power *= h) scaled.push_back(law_.value(condition, k) * power);
    const auto root = first_root(scaled, T(zero_tolerance<T>() * law_.scale(condition, 0)));  // as decide() sees it
    if (root && (!first || *root * h < *first)) first = *root * h;
  }
  return first;
}

/// Guides whose sliding speed is zero at tau, to rounding, are at rest from then on.
template <class T>
void Integrator<T>::find_rest(const T& tau) {
  using std::abs;
  for (int g = 0; g < dynamics_.guides(); ++g) {
    if (!dynamics_.guide(g).rough() || at_rest_[static_cast<std::size_t>(g)]) continue;
    const auto& speed = dynamics_.sliding(g).speed;
    T sum(0), size(0), power(1);
    for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); ++i) {  // each term can vanish with the speed
      if (i % 3 < 2) size = std::max(size, T(abs(motion_.velocity[static_cast<std::size_t>(i)])));
    }
    for (int k = 0; k <= order_; ++k, power *= tau) {
      sum += speed[k] * power;
      size += abs(speed[k] * power);
    }
    at_rest_[static_cast<std::size_t>(g)] = abs(sum) <= zero_tolerance<T>() * size;
  }
}

template <class T>
T Integrator<T>::at(const typename Tape<T>::Node& node, const T& tau, int last) const {
  T sum(0);
  for (int k = last; k >= 0; --k) sum = sum * tau + node[k];
  return sum;
}

template <class T>
T Integrator<T>::rate_at(const typename Tape<T>::Node& node, const T& tau, int last) const {
  T sum(0);
  for (int k = last; k >= 1; --k) sum = sum * tau + T(k) * node[k];
  return sum;
}

template <class T>
T Integrator<T>::unknown_at(int unknown, const T& tau) const {
  T sum(0);
  for (int k = order_ - 1; k >= 0; --k) sum = sum * tau + dynamics_.unknown(unknown, k);
  return sum;
}

template <class T>
T Integrator<T>::integral(const std::vector<T>& power, const T& tau) const {
  T sum(0);
  for (int k = order_ - 1; k >= 0; --k) sum = (sum + power[static_cast<std::size_t>(k)] / T(k + 1)) * tau;
  return sum;
}

template <class T>
Motion<T> Integrator<T>::motion_at(const T& tau) const {
  Motion<T> motion{T(motion_.t + tau), {}, {}};
  for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); ++i) {
    motion.position.push_back(at(dynamics_.mechanism.position(i), tau, order_ + 1));
    motion.velocity.push_back(rate_at(dynamics_.mechanism.position(i), tau, order_ + 1));
  }
  return motion;
}

template <class T>
void Integrator<T>::expand_powers() {
  const auto& mechanism = dynamics_.mechanism;
  work_power_.clear();
  dissipated_power_.clear();
  for (int k = 0; k < order_; ++k) {
    T in = mechanism.load_power[k], out = mechanism.damper_power[k];
    for (int j = 0; j <= k; ++j) {
      for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
        const int drive = static_cast<int>(d);
        in += dynamics_.unknown(dynamics_.unknown_of_drive(drive), j) * mechanism.driven(drive).speed[k - j];
      }
      for (int g = 0; g < dynamics_.guides(); ++g) out -= dynamics_.friction(g, j) * dynamics_.sliding(g).speed[k - j];
    }
    work_power_.push_back(in);
    dissipated_power_.push_back(out);
  }
}

template <class T>
Instant<T> Integrator<T>::instant(const T& tau) const {
  using std::cos, std::sin;
  const auto& mechanism = dynamics_.mechanism;
  Instant<T> now;
  now.t = motion_.t + tau;
  for (const auto& row : mechanism.coordinate) {
    now.q.push_back(at(row.value, tau, order_ + 1));
    now.v.push_back(at(row.speed, tau, order_));
    now.acceleration.push_back(rate_at(row.speed, tau, order_));
  }
  for (int c = 0; c < dynamics_.contacts(); ++c) now.lambda.push_back(unknown_at(dynamics_.unknown_of_contact(c), tau));
  for (int g = 0; g < dynamics_.guides(); ++g) {
    T friction(0);
    for (int k = order_ - 1; k >= 0; --k) friction = friction * tau + dynamics_.friction(g, k);
    now.friction.push_back(friction);
    now.slip.push_back(at(dynamics_.sliding(g).speed, tau, order_));
  }
  for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
    now.drive.push_back(unknown_at(dynamics_.unknown_of_drive(static_cast<int>(d)), tau));
  }
  for (std::size_t p = 0; p < mechanism.model.pin.size(); ++p) {  // from body b's frame to the world's
    const int row = 2 * static_cast<int>(p), b = mechanism.model.pin[p].b;
    const T x = unknown_at(dynamics_.unknown_of_pin(row), tau), y = unknown_at(dynamics_.unknown_of_pin(row + 1), tau);
    const T angle = b == ground ? T(0) : at(mechanism.position(3 * b + 2), tau, order_ + 1);
    const T c = cos(angle), s = sin(angle);
    now.pin.insert(now.pin.end(), {T(c * x - s * y), T(s * x + c * y)});
  }
  now.kinetic = T(0);
  const Motion<T> motion = motion_at(tau);
  for (int i = 0; i < 3 * mechanism.bodies(); ++i) {
    const T& v = motion.velocity[static_cast<std::size_t>(i)];
    now.kinetic += mechanism.mass(i) * v * v / 2;
  }
  now.energy = now.kinetic + at(mechanism.potential, tau, order_ + 1);
  now.work = work_ + integral(work_power_, tau);
  now.dissipated = dissipated_ + integral(dissipated_power_, tau);
  now.mode = shown_mode();
  now.chosen = chosen_;
  return now;
}

template <class T>
Mode Integrator<T>::shown_mode() const {
  Mode shown = mode_;
  for (std::size_t g = 0; g < shown.slip.size(); ++g) shown.slip[g] = at_rest_[g] ? 0 : shown.slip[g];
  return shown;
}

template <class T>
void Integrator<T>::take_events(const Mode& before) {
  const Mode now = shown_mode();
  for (int g = 0, c = 0; g < dynamics_.guides(); ++g) {
    const int was = before.slip[static_cast<std::size_t>(g)], is = now.slip[static_cast<std::size_t>(g)];
    if (was != is) {
      const EventKind kind = is == 0 ? EventKind::stick : was == 0 ? EventKind::slip : EventKind::slip_reversal;
      result_.events.push_back({motion_.t, g, none, kind});
    }
    for (std::size_t k = 0; k < dynamics_.guide(g).contact.size(); ++k, ++c) {
      if (before.sign[static_cast<std::size_t>(c)] == now.sign[static_cast<std::size_t>(c)]) continue;
      if (!(dynamics_.guide(g).mu_static > 0)) continue;
      result_.events.push_back({motion_.t, g, c, EventKind::normal_reversal});
    }
  }
}

extern template class Integrator<Real>;

/// Decimal digits that two trajectories share: in every kind of quantity at every sample, relative to the largest of
/// its kind, and in the times of their events, relative to the duration. 0 if they differ in their events.
double shared_digits(const Trajectory<Real>& a, const Trajectory<Real>& b);

/// A trajectory with the digits that it shares with another one, of six more digits of truncation and 0.8 of the step.
struct Validated {
  Trajectory<Real> trajectory;
  double digits;
};

/// Both at the same time, each on a core. Progress is that of the better one, which is returned.
Validated integrate_twice(const Model<Real>& model, const Real& duration, const std::vector<Real>& times,
                          const TrajectoryOptions& options);

}  // namespace slideway::oracle
