// Time stepping: State -> State, or a refusal that leaves every byte of the state as it was.
#pragma once

#include <slideway/project.hpp>

namespace slideway {

enum class Method : unsigned char {
  euler,     ///< semi-implicit: v, then q with the new v; order 1
  rk4,       ///< classical Runge-Kutta with an HLCP in every stage (WWZ14); order 4 between events
  kinematic  ///< fully driven scenes: positions solved, not integrated; an HLCP for the reactions
};

constexpr const char* name(Method method) noexcept {
  return method == Method::euler ? "euler" : method == Method::rk4 ? "rk4" : "kinematic";
}

template <class Source>
class BasicStepper {
 public:
  using Size = typename Source::Size;
  using State = slideway::State<Size>;
  using Inputs = slideway::Inputs<Size>;
  using Reaction = slideway::Reaction<Size>;

  Source source;
  Method method = Method::rk4;
  HlcpOptions hlcp{};
  Gains gains{source.scene.alpha, source.scene.beta};
  double drift_limit = 1e-3;  ///< largest |Phi|, |phi| that a step may meet, in lengths of the scene (or rad)

  template <class... Data>
  explicit constexpr BasicStepper(const Data&... data) noexcept : source(data...) {}

  /// The scene's start. Slip directions and contact signs are found by the first step.
  constexpr State start() const noexcept {
    State state;
    for (int i = 0, j = 0; i < source.scene.bodies; ++i) {
      for (int k = 0; k < coordinates(source.scene.body[i].joint); ++k, ++j) {
        state.q[j] = source.scene.body[i].q[k];
        state.v[j] = source.scene.body[i].v[k];
      }
    }
    return state;
  }

  /// One step of dt > 0, s. On ok the state is advanced; otherwise it is untouched and the report says why.
  /// No heap; at most four evaluations of `accelerate` (three projections for kinematic).
  Report step(State& state, double dt, const Inputs& inputs = {}) const noexcept {
    Report report;
    State next = state;
    if (dt != next.dt) {
      next.start = state.time();
      next.steps = 0;
      next.dt = dt;
    }
    if (!(dt > 0) || !detail::finite(dt) || !finite(state, inputs)) {
      report.status = Status::invalid_input;
      return report;
    }
    report.status = method == Method::rk4     ? step_rk4(next, inputs, report)
                    : method == Method::euler ? step_euler(next, inputs, report)
                                              : step_kinematic(next, inputs, report);
    ++next.steps;
    if (report.status == Status::ok && !finite(next, inputs)) report.status = Status::inaccurate;
    if (report.status == Status::ok && !(report.drift_position <= drift_limit * source.tables.length)) {
      report.status = Status::drift_limit;
    }
    if (report.status == Status::ok) state = next;
    return report;
  }

  /// Forces and accelerations at the state. r is valid when the report's status is ok.
  Report reaction(const State& state, const Inputs& inputs, Reaction& r) const noexcept {
    Report report;
    if (!finite(state, inputs)) {
      report.status = Status::invalid_input;
      return report;
    }
    State copy = state;
    report.status = evaluate(state.time(), 0, copy.q, copy.v, inputs, copy, r, report);
    return report;
  }

  /// Moves the state onto the constraints: project.hpp. Untouched unless the report says ok.
  Report project(State& state, const Inputs& inputs = {}) const noexcept {
    Report report;
    State next = state;
    report.status = finite(state, inputs) ? slideway::project(source, next.time(), 0, inputs, next.q, next.v)
                                          : Status::invalid_input;
    if (report.status == Status::ok) state = next;
    return report;
  }

  /// Kinetic energy, J.
  double kinetic_energy(const State& state) const noexcept {
    const Kinematics<Size> k = place(state);
    double energy = 0;
    for (int i = 0; i < source.scene.bodies; ++i) {
      const Body& body = source.scene.body[i];
      const Vec2 v = point_at(source, k, i, body.com, {true, true}).velocity;
      energy += 0.5 * (body.mass * dot(v, v) + body.inertia * k.rate[i] * k.rate[i]);
    }
    return energy;
  }

  /// Potential energy of gravity and springs, J.
  double potential_energy(const State& state) const noexcept {
    const Kinematics<Size> k = place(state);
    double energy = 0;
    for (int i = 0; i < source.scene.bodies; ++i) {
      const Body& body = source.scene.body[i];
      energy -= body.mass * dot(source.scene.gravity, point_at(source, k, i, body.com, {true, true}).place);
    }
    for (int s = 0; s < source.scene.springs; ++s) {
      const Spring& spring = source.scene.spring[s];
      const Vec2 gap = point_at(source, k, spring.a, spring.a_at, {true, true}).place -
                       point_at(source, k, spring.b, spring.b_at, {true, true}).place;
      const double stretch = std::sqrt(dot(gap, gap)) - spring.length;
      energy += 0.5 * spring.stiffness * stretch * stretch;
    }
    for (int s = 0; s < source.scene.joint_springs; ++s) {
      const JointSpring& spring = source.scene.joint_spring[s];
      const double stretch = state.q[source.tables.first[spring.body]] - spring.rest;
      energy += 0.5 * spring.stiffness * stretch * stretch;
    }
    return energy;
  }

 private:
  static constexpr int n = at_least_one(Size::coordinates);

  Kinematics<Size> place(const State& state) const noexcept {
    Kinematics<Size> k;
    const double none_prescribed[n] = {};
    kinematics(source, state.q, state.v, none_prescribed, k);
    return k;
  }

  /// A sum of finite numbers far from overflow is finite, and one that is not finite makes it so.
  bool finite(const State& state, const Inputs& inputs) const noexcept {
    double sum = state.start;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      sum += (state.q[j] - state.q[j]) + (state.v[j] - state.v[j]);
    });
    for_each<Source, Size::inputs>(source.scene.inputs, [&](int i) SLIDEWAY_FOLD {
      const Input& in = inputs.input[i];
      sum += (in.value - in.value) + (in.rate - in.rate) + (in.acceleration - in.acceleration);
    });
    return detail::finite(sum);
  }

  /// accelerate(), with mode and sign of `at` as guesses and answers.
  Status evaluate(double t, double tau, const double* q, const double* v, const Inputs& inputs, State& at, Reaction& r,
                  Report& report) const noexcept {
    return accelerate(source, t, tau, q, v, inputs, Solving{gains, hlcp, tau == 0}, at.mode, at.sign, r, report);
  }

  /// Marks what has another slip direction or contact sign than before the step.
  void mark_events(const State& before, const State& now, bool* reversed) const noexcept {
    for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
      reversed[g] = reversed[g] || before.mode[g] * now.mode[g] < 0;
    });
    for_each<Source, Size::contacts>(source.tables.rough, [&](int m) SLIDEWAY_FOLD {
      const int c = source.tables.rough_contact[m];
      reversed[Size::guides + c] = reversed[Size::guides + c] || before.sign[c] * now.sign[c] < 0;
    });
  }

  static constexpr int n_marks = at_least_one(Size::guides + Size::contacts);

  int count_events(const bool* reversed) const noexcept {
    int count = 0;
    for (int m = 0; m < Size::guides + Size::contacts; ++m) count += reversed[m] ? 1 : 0;
    return count;
  }

  static void add(EnergyFlow& sum, double weight, const EnergyFlow& power) noexcept {
    sum.work += weight * power.work;
    sum.dissipated += weight * power.dissipated;
    sum.constraint_work += weight * power.constraint_work;
  }

  Status step_rk4(State& next, const Inputs& inputs, Report& report) const noexcept {
    constexpr double node[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    const State before = next;
    const double h = next.dt, t = next.time();
    double q[n], v[n], q_sum[n] = {}, v_sum[n] = {};
    bool reversed[n_marks] = {};
    Reaction r;
    for (int stage = 0; stage < 4; ++stage) {
      const double tau = node[stage] * h;
      for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
        const double slope_q = stage == 0 ? 0 : v[j], slope_v = stage == 0 ? 0 : r.acceleration[j];
        q[j] = before.q[j] + tau * slope_q;
        v[j] = before.v[j] + tau * slope_v;
      });
      const Status status = evaluate(t + tau, tau, q, v, inputs, next, r, report);
      if (status != Status::ok) return status;
      for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
        q_sum[j] += weight[stage] * v[j];
        v_sum[j] += weight[stage] * r.acceleration[j];
      });
      add(report.energy, weight[stage] * (h / 6), r.power);
      mark_events(before, next, reversed);
    }
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      next.q[j] = before.q[j] + h / 6 * q_sum[j];
      next.v[j] = before.v[j] + h / 6 * v_sum[j];
    });
    report.unlocated_events = count_events(reversed);
    return Status::ok;
  }

  Status step_euler(State& next, const Inputs& inputs, Report& report) const noexcept {
    const State before = next;
    const double h = next.dt;
    bool reversed[n_marks] = {};
    Reaction r;
    const Status status = evaluate(next.time(), 0, before.q, before.v, inputs, next, r, report);
    if (status != Status::ok) return status;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      next.v[j] = before.v[j] + h * r.acceleration[j];
      next.q[j] = before.q[j] + h * next.v[j];
    });
    add(report.energy, h, r.power);
    mark_events(before, next, reversed);
    report.unlocated_events = count_events(reversed);
    return Status::ok;
  }

  /// Reactions at the start, middle and end of the step, for Simpson's rule of the energies.
  Status step_kinematic(State& next, const Inputs& inputs, Report& report) const noexcept {
    if (!fully_driven(source)) return Status::invalid_input;
    constexpr double weight[3] = {1, 4, 1};
    const State before = next;
    const double h = next.dt, t = next.time();
    bool reversed[n_marks] = {};
    Reaction r;
    for (int stage = 0; stage < 3; ++stage) {
      const double tau = 0.5 * stage * h;
      if (stage > 0) {
        for (int j = 0; j < source.tables.coordinates; ++j) next.q[j] += 0.5 * h * next.v[j];
        const Status placed = slideway::project(source, t + tau, tau, inputs, next.q, next.v);
        if (placed != Status::ok) return placed;
      }
      const Status status = evaluate(t + tau, tau, next.q, next.v, inputs, next, r, report);
      if (status != Status::ok) return status;
      add(report.energy, weight[stage] * (h / 6), r.power);
      mark_events(before, next, reversed);
    }
    report.unlocated_events = count_events(reversed);
    return Status::ok;
  }
};

/// Steps a scene that the compiler knows. The scene is a constexpr variable at namespace scope.
template <const auto& scene>
using Stepper = BasicStepper<CompileTime<scene>>;

/// Steps a scene that is known when the program runs; keeps a copy of it.
template <class Size>
using RunTimeStepper = BasicStepper<RunTime<Size>>;

}  // namespace slideway
