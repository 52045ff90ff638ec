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

/// Steps a scene. Its options are public members, Solving's among them; stepping changes none.
template <class Source>
class BasicStepper : public Solving {
 public:
  using Size = typename Source::Size;
  using State = slideway::State<Size>;
  using Inputs = slideway::Inputs<Size>;
  using Reaction = slideway::Reaction<Size>;

  Source source;
  Method method = Method::rk4;
  double drift_limit = 1e-3;  ///< largest |Phi|, |phi| that a step may start from, m or rad, for each m of length

  template <class... Data>
  explicit constexpr BasicStepper(const Data&... data) noexcept : source(data...) {
    gains = {source.scene.alpha, source.scene.beta};
  }

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
  /// No heap; at most four evaluations of `accelerate`; for kinematic three, and two projections.
  Report step(State& state, double dt, const Inputs& inputs = {}) const noexcept {
    Report report;
    const bool same_dt = dt == state.dt;
    const double start = same_dt ? state.start : state.time();
    const long long steps = same_dt ? state.steps : 0;
    const double t = start + static_cast<double>(steps) * dt;
    if (!source.sound || !(dt > 0) || !detail::finite(t)) {
      report.status = Status::invalid_input;
      return report;
    }
    Next next;
    begin(state, next);
    report.status = method == Method::rk4     ? step_rk4(state, t, dt, inputs, next, report)
                    : method == Method::euler ? step_euler(state, t, dt, inputs, next, report)
                                              : step_kinematic(state, t, dt, inputs, next, report);
    if (report.status == Status::ok && !finite(next.q, next.v)) report.status = Status::inaccurate;
    if (report.status == Status::ok && !(report.drift_position <= drift_limit * source.tables.length)) {
      report.status = Status::drift_limit;
    }
    if (report.status != Status::ok) {
      if (!finite(state, inputs)) report.status = Status::invalid_input;
      return report;
    }
    report.unlocated_events = finish(next, state);
    state.start = start;
    state.dt = dt;
    state.steps = steps + 1;
    return report;
  }

  /// Forces and accelerations at the state. r is valid when the report's status is ok.
  Report reaction(const State& state, const Inputs& inputs, Reaction& r) const noexcept {
    Report report;
    if (!source.sound || !detail::finite(state.time())) {
      report.status = Status::invalid_input;
      return report;
    }
    Next at;
    begin(state, at);
    report.status = evaluate(state.time(), 0, state.q, state.v, inputs, at, r, report);
    if (report.status == Status::ok && !(report.drift_position <= drift_limit * source.tables.length)) {
      report.status = Status::drift_limit;
    }
    if (report.status != Status::ok && !finite(state, inputs)) report.status = Status::invalid_input;
    return report;
  }

  /// Moves the state onto the constraints: project.hpp. Untouched unless the report says ok.
  Report project(State& state, const Inputs& inputs = {}) const noexcept {
    Report report;
    State next = state;
    report.status = source.sound && finite(state, inputs)
                        ? slideway::project(source, next.time(), 0, inputs, next.q, next.v)
                        : Status::invalid_input;
    if (report.status == Status::ok && !finite(next.q, next.v)) report.status = Status::no_convergence;
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

  /// What a step makes, apart from the state until it is known to be good. `first_` is of the first stage, at the state
  /// itself; `_reversed` marks what was another at some stage than there, or there than after the step before.
  struct Next {
    double q[n], v[n];
    signed char mode[at_least_one(Size::guides)], sign[at_least_one(Size::contacts)];
    signed char first_mode[at_least_one(Size::guides)], first_sign[at_least_one(Size::contacts)];
    bool slip_reversed[at_least_one(Size::guides)], force_reversed[at_least_one(Size::contacts)];
  };

  void begin(const State& state, Next& next) const noexcept {
    for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
      next.mode[g] = state.mode[g];
      next.slip_reversed[g] = false;
    });
    for_each<Source, Size::contacts>(source.tables.contacts, [&](int c) SLIDEWAY_FOLD {
      next.sign[c] = state.sign[c];
      next.force_reversed[c] = false;
    });
  }

  /// next into state; the number of events that the step went over.
  int finish(const Next& next, State& state) const noexcept {
    int events = 0;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      state.q[j] = next.q[j];
      state.v[j] = next.v[j];
    });
    for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
      state.mode[g] = next.mode[g];
      events += next.slip_reversed[g] ? 1 : 0;
    });
    for_each<Source, Size::contacts>(source.tables.contacts, [&](int c) SLIDEWAY_FOLD {
      state.sign[c] = next.sign[c];
      events += next.force_reversed[c] ? 1 : 0;
    });
    return events;
  }

  /// A sum of finite numbers far from overflow is finite, and one that is not finite makes it so.
  bool finite(const double* q, const double* v) const noexcept {
    double sum = 0;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD { sum += q[j] + v[j]; });
    return detail::finite(sum);
  }

  bool finite(const State& state, const Inputs& inputs) const noexcept {
    double sum = state.start;
    for (int i = 0; i < source.scene.inputs; ++i) {
      sum += inputs.input[i].value + inputs.input[i].rate + inputs.input[i].acceleration;
    }
    return detail::finite(sum) && finite(state.q, state.v);
  }

  /// accelerate(), with mode and sign of `at` as guesses and answers.
  Status evaluate(double t, double tau, const double* q, const double* v, const Inputs& inputs, Next& at, Reaction& r,
                  Report& report) const noexcept {
    return accelerate(source, t, tau, q, v, inputs, *this, tau == 0, at.mode, at.sign, r, report);
  }

  /// The same within a step: its share of the energies, and what has reversed.
  Status stage(const State& before, double t, double tau, double weight, const double* q, const double* v,
               const Inputs& inputs, Next& next, Reaction& r, Report& report) const noexcept {
    const Status status = evaluate(t + tau, tau, q, v, inputs, next, r, report);
    if (status != Status::ok) return status;
    report.energy.work += weight * r.power.work;
    report.energy.dissipated += weight * r.power.dissipated;
    report.energy.constraint_work += weight * r.power.constraint_work;
    for_each<Source, Size::contacts>(source.tables.rough, [&](int m) SLIDEWAY_FOLD {
      const int c = source.tables.rough_contact[m], g = source.tables.guide_of[c];
      next.slip_reversed[g] |= (tau == 0 ? before.mode[g] : next.first_mode[g]) * next.mode[g] < 0;
      next.force_reversed[c] |= (tau == 0 ? before.sign[c] : next.first_sign[c]) * next.sign[c] < 0;
      if (tau != 0) return;
      next.first_mode[g] = next.mode[g];
      next.first_sign[c] = next.sign[c];
    });
    return Status::ok;
  }

  /// With a_i the accelerations of the four stages: v + h/6 (a1 + 2 a2 + 2 a3 + a4), and since the stages' speeds are
  /// v, v + h/2 a1, v + h/2 a2, v + h a3, q + h v + h^2/6 (a1 + a2 + a3).
  Status step_rk4(const State& state, double t, double h, const Inputs& inputs, Next& next,
                  Report& report) const noexcept {
    constexpr double node[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    double q[n], v[n], sum[n], weighted_sum[n];
    Reaction r;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      q[j] = state.q[j];
      v[j] = state.v[j];
      sum[j] = weighted_sum[j] = r.acceleration[j] = 0;
    });
    for (int k = 0; k < 4; ++k) {
      const double tau = node[k] * h;
      const Status status = stage(state, t, tau, weight[k] * (h / 6), q, v, inputs, next, r, report);
      if (status != Status::ok) return status;
      const double reach = k < 3 ? node[k + 1] * h : 0;
      for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
        const double a = r.acceleration[j];
        weighted_sum[j] += weight[k] * a;
        if (k == 3) return;
        sum[j] += a;
        q[j] = state.q[j] + reach * v[j];
        v[j] = state.v[j] + reach * a;
      });
    }
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      next.q[j] = state.q[j] + h * (state.v[j] + h / 6 * sum[j]);
      next.v[j] = state.v[j] + h / 6 * weighted_sum[j];
    });
    return Status::ok;
  }

  Status step_euler(const State& state, double t, double h, const Inputs& inputs, Next& next,
                    Report& report) const noexcept {
    Reaction r;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD { r.acceleration[j] = 0; });
    const Status status = stage(state, t, 0, h, state.q, state.v, inputs, next, r, report);
    if (status != Status::ok) return status;
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      next.v[j] = state.v[j] + h * r.acceleration[j];
      next.q[j] = state.q[j] + h * next.v[j];
    });
    return Status::ok;
  }

  /// Reactions at the start, middle and end of the step, for Simpson's rule of the energies.
  Status step_kinematic(const State& state, double t, double h, const Inputs& inputs, Next& next,
                        Report& report) const noexcept {
    if (!fully_driven(source)) return Status::invalid_input;
    constexpr double weight[3] = {1, 4, 1};
    Reaction r;
    for (int k = 0; k < 3; ++k) {
      const double tau = 0.5 * k * h;
      for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
        next.q[j] = k == 0 ? state.q[j] : next.q[j] + 0.5 * h * next.v[j];
        if (k == 0) next.v[j] = state.v[j];
      });
      if (k > 0) {
        const Status placed = slideway::project(source, t + tau, tau, inputs, next.q, next.v);
        if (placed != Status::ok) return placed;
      }
      const Status status = stage(state, t, tau, weight[k] * (h / 6), next.q, next.v, inputs, next, r, report);
      if (status != Status::ok) return status;
    }
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
