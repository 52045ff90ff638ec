// Time stepping: State -> State, or a refusal that leaves every byte of the state as it was.
#pragma once

#include <slideway/events.hpp>
#include <slideway/method.hpp>

namespace slideway {

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
  Stabilise stabilise = Stabilise::baumgarte;
  double theta = 0.5;             ///< of moreau: 1/2 takes forces at the middle of the step, 1 at its start
  int max_events = Report::room;  ///< that one step of a located method may span, at most Report::room
  double drift_limit = 1e-3;      ///< largest |Phi|, |phi| that a step may start from, m or rad, for each m of length

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
  /// No heap. Evaluations of accelerations and forces: euler 1, rk4 4 (one more where a sliding speed changes its
  /// sign), kinematic 3 and two projections, moreau 1; located methods: events.hpp.
  Report step(State& state, double dt, const Inputs& inputs = {}) const noexcept;

  /// Forces and accelerations at the state, just after it. r is valid when the report's status is ok.
  /// By moreau: the means of a step of state.dt from there, once there is one.
  Report reaction(const State& state, const Inputs& inputs, Reaction& r) const noexcept;

  /// Moves the state onto the constraints: project.hpp. Untouched unless the report says ok.
  Report project(State& state, const Inputs& inputs = {}) const noexcept;

  /// Kinetic energy, J.
  double kinetic_energy(const State& state) const noexcept {
    const Kinematics<Size> k = place(state.q, state.v);
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
    const Kinematics<Size> k = place(state.q, state.v);
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
  using Phase = slideway::Phase<Size>;
  using Modes = slideway::Modes<Size>;
  using Setting = slideway::Setting<Source>;

  Kinematics<Size> place(const double* q, const double* v) const noexcept {
    Kinematics<Size> k;
    const double none_prescribed[n] = {};
    kinematics(source, q, v, none_prescribed, k);
    return k;
  }

  /// Baumgarte's gains, or none where projection takes their place.
  Solving solving() const noexcept {
    Solving s = *this;
    if (stabilise == Stabilise::projection) s.gains = {0, 0};
    return s;
  }

  void begin(const State& state, Phase& y, Modes& m) const noexcept {
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      y.q[j] = state.q[j];
      y.v[j] = state.v[j];
    });
    for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
      m.mode[g] = state.mode[g];
      m.still[g] = m.leaving[g] = m.bound[g] = false;
      m.stiction[g] = 0;
    });
    for_each<Source, Size::contacts>(source.tables.contacts, [&](int c) SLIDEWAY_FOLD { m.sign[c] = state.sign[c]; });
    m.decided = state.decided;
  }

  void finish(const Phase& y, const Modes& m, State& state) const noexcept {
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      state.q[j] = y.q[j];
      state.v[j] = y.v[j];
    });
    for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD { state.mode[g] = m.mode[g]; });
    for_each<Source, Size::contacts>(source.tables.contacts, [&](int c) SLIDEWAY_FOLD { state.sign[c] = m.sign[c]; });
    state.decided = true;
  }

  /// A sum of finite numbers far from overflow is finite, and one that is not finite makes it so.
  bool finite(const double* q, const double* v, double sum = 0) const noexcept {
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

  Status advance(const Setting& setting, double h, const State& state, Phase& y, Modes& m) const noexcept {
    switch (method) {
      case Method::euler:
        return step_euler(setting, h, state, y, m);
      case Method::rk4:
        return step_rk4(setting, h, state, y, m);
      case Method::rk4_located:
        return step_located<runge_kutta_4>(setting, h, y, m);
      case Method::dop853_located:
        return step_located<dormand_prince_8>(setting, h, y, m);
      case Method::moreau:
        return step_moreau(setting, h, state, y, m);
      case Method::kinematic:
        return step_kinematic(setting, h, state, y, m);
    }
    return Status::invalid_input;
  }

  template <const auto& tableau>
  [[gnu::noinline]] Status step_located(const Setting& setting, double h, Phase& y, Modes& m) const noexcept {
    return LocatedStep<tableau, Source>(setting, max_events).run(h, y, m);
  }

  /// Which guides and contacts have changed their mode or sign within a step that does not locate it.
  struct Changes {
    bool mode[at_least_one(Size::guides)] = {}, sign[at_least_one(Size::contacts)] = {};
  };

  /// Changes from one evaluation to another; a first evaluation has nothing before it.
  void compare(const signed char* mode, const signed char* sign, bool decided, const Modes& now,
               Changes& changes) const noexcept {
    if (!decided) return;
    for_each<Source, Size::contacts>(source.tables.rough, [&](int i) SLIDEWAY_FOLD {
      const int c = source.tables.rough_contact[i], g = source.tables.guide_of[c];
      changes.mode[g] |= mode[g] != now.mode[g];
      changes.sign[c] |= source.scene.guide[g].mu_static > 0 && sign[c] != now.sign[c];
    });
  }

  int count(const Changes& changes) const noexcept {
    int events = 0;
    for_each<Source, Size::guides>(source.scene.guides,
                                   [&](int g) SLIDEWAY_FOLD { events += changes.mode[g] ? 1 : 0; });
    for_each<Source, Size::contacts>(source.tables.contacts,
                                     [&](int c) SLIDEWAY_FOLD { events += changes.sign[c] ? 1 : 0; });
    return events;
  }

  /// At a step's end: guides whose sliding speed has changed its sign within the step, at a stage (`crossed`) or at the
  /// end, would chatter or creep. With that speed at zero the law at rest is asked; those that stick there lose it, by
  /// the least change in the mass metric. A motion that the forces bring through it within the step is away from it by
  /// no more than `reach`, h times the first stage's accelerations; twice that, since these change meanwhile.
  void arrest(const Setting& setting, double h, const double* acceleration, const Modes& first, const bool* crossed,
              Phase& y, Modes& m, Changes& changes) const noexcept {
    const Kinematics<Size> k = place(y.q, y.v);
    signed char moves[at_least_one(Size::guides)], back[at_least_one(Size::guides)];
    bool any = false;
    for (int g = 0; g < source.scene.guides; ++g) {
      Sliding s;
      sliding(source, k, g, s);
      back[g] = static_cast<signed char>(s.slip[0] > 0 ? 1 : s.slip[0] < 0 ? -1 : 0);
      const bool turned = crossed[g] || first.mode[g] * s.slip[0] <= 0;
      moves[g] = source.tables.is_rough[g] && first.mode[g] != 0 && turned ? 0 : 1;
      any = any || moves[g] == 0;
    }
    if (!any) return;
    Phase at_rest = y;
    Modes held = m;
    double reach[n];
    for (int j = 0; j < source.tables.coordinates; ++j) reach[j] = h * acceleration[j];
    if (!Projection<Source>(source, setting.inputs, h, at_rest.q, at_rest.v).arrest(moves, 2, reach)) return;
    for (int g = 0; g < source.scene.guides; ++g) {
      if (moves[g] != 0) continue;
      held.mode[g] = 0;
      held.still[g] = true;
      changes.mode[g] = true;
      if (back[g] != 0) m.mode[g] = back[g];
    }
    Reaction r;
    const Uniqueness uniqueness = setting.report.uniqueness;
    const int guide = setting.report.guide;
    const Status status = setting.evaluate(h, at_rest, Aim::decide, false, held, r);
    bool all = true, none_sticks = true;
    for (int g = 0; g < source.scene.guides && status == Status::ok; ++g) {
      if (moves[g] != 0) continue;
      if (held.mode[g] == 0) m.mode[g] = 0;
      all = all && held.mode[g] == 0;
      none_sticks = none_sticks && held.mode[g] != 0;
      if (held.mode[g] != 0) moves[g] = 1;
    }
    if (none_sticks) {  // what was asked there decides nothing
      setting.report.uniqueness = uniqueness;
      setting.report.guide = guide;
      return;
    }
    if (!all) {
      at_rest = y;
      Projection<Source>(source, setting.inputs, h, at_rest.q, at_rest.v).arrest(moves, 2, reach);
    }
    y = at_rest;
  }

  /// An HLCP in every stage. A guide that is at rest in the first keeps the set-valued law in the others.
  [[gnu::noinline]] Status step_rk4(const Setting& setting, double h, const State& state, Phase& y,
                                    Modes& m) const noexcept {
    Reaction r;
    const Status status = setting.evaluate(0, y, Aim::decide, true, m, r);
    if (status != Status::ok) return status;
    m.decided = true;
    Changes changes;
    compare(state.mode, state.sign, state.decided, m, changes);
    const Modes first = m;
    double lowest[at_least_one(Size::guides)], highest[at_least_one(Size::guides)];
    for_each<Source, Size::guides>(source.scene.guides,
                                   [&](int g) SLIDEWAY_FOLD { lowest[g] = highest[g] = r.slip[g]; });
    Stages<runge_kutta_4, Source> stages;
    const Status made = stages.run(
        setting, 0, h, y, r, Aim::decide, m,
        [&](int) SLIDEWAY_FOLD {
          for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
            if (first.mode[g] == 0) m.mode[g] = 0;
          });
        },
        [&](int, const Reaction& at) SLIDEWAY_FOLD {
          compare(first.mode, first.sign, true, m, changes);
          for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
            lowest[g] = at.slip[g] < lowest[g] ? at.slip[g] : lowest[g];
            highest[g] = larger(highest[g], at.slip[g]);
          });
        });
    if (made != Status::ok) return made;
    y = stages.to;
    add(setting.report.energy, 1, stages.flow);
    bool crossed[at_least_one(Size::guides)], near = false;  // near: a speed as near to zero as it changes by
    for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
      const double range = highest[g] - lowest[g];
      crossed[g] = lowest[g] <= 0 && highest[g] >= 0;
      near |= source.tables.is_rough[g] && first.mode[g] != 0 && lowest[g] - range <= 0 && highest[g] + range >= 0;
    });
    if (near) arrest(setting, h, r.acceleration, first, crossed, y, m, changes);
    setting.report.unlocated_events = count(changes);
    return Status::ok;
  }

  [[gnu::noinline]] Status step_euler(const Setting& setting, double h, const State& state, Phase& y,
                                      Modes& m) const noexcept {
    Reaction r;
    const Status status = setting.evaluate(0, y, Aim::decide, true, m, r);
    if (status != Status::ok) return status;
    m.decided = true;
    Changes changes;
    compare(state.mode, state.sign, state.decided, m, changes);
    add(setting.report.energy, h, r.power);
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      y.v[j] += h * r.acceleration[j];
      y.q[j] += h * y.v[j];
    });
    const Modes first = m;
    const bool crossed[at_least_one(Size::guides)] = {};
    if (source.tables.rough > 0) arrest(setting, h, r.acceleration, first, crossed, y, m, changes);
    setting.report.unlocated_events = count(changes);
    return Status::ok;
  }

  /// Moreau's theta method (Moreau 1988; Acary and Brogliato 2008, ch. 10): rates of constraints and Coulomb's law,
  /// set-valued for every guide, are imposed on v+ = v + h a at q_m = q + (1 - theta) h v, so that forces are means
  /// over the step, impulses over h: finite even where accelerations have no solution.
  ///   M(q_m) a = h(q_m, v) + forces;  Phi'+ = -(beta / alpha) Phi;  q+ = q_m + theta h v+
  [[gnu::noinline]] Status step_moreau(const Setting& setting, double h, const State& state, Phase& y,
                                       Modes& m) const noexcept {
    Reaction r;
    const Status status = impulse(setting, h, y, m, r);
    if (status != Status::ok) return status;
    Changes changes;
    compare(state.mode, state.sign, state.decided, m, changes);
    setting.report.unlocated_events = count(changes);
    add(setting.report.energy, h, r.power);
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      y.v[j] += h * r.acceleration[j];
      y.q[j] += theta * h * y.v[j];
    });
    return Status::ok;
  }

  /// The means of a step of h from y; y.q becomes q_m.
  Status impulse(const Setting& setting, double h, Phase& y, Modes& m, Reaction& r) const noexcept {
    const double before = (1 - theta) * h;
    for_each<Source, Size::coordinates>(source.tables.coordinates,
                                        [&](int j) SLIDEWAY_FOLD { y.q[j] += before * y.v[j]; });
    Solving means = setting.solving;
    const Gains given = setting.solving.gains;
    means.gains = {1 / h, given.alpha > 0 ? given.beta / given.alpha / h : 0, 0};
    return accelerate(
        source, Moment<Size>{setting.t + before, before, y.q, y.v, setting.inputs, Aim::impulse, true, h, h - before},
        means, m, r, setting.report);
  }

  /// Reactions at the start, middle and end of the step, for Simpson's rule of the energies.
  [[gnu::noinline]] Status step_kinematic(const Setting& setting, double h, const State& state, Phase& y,
                                          Modes& m) const noexcept {
    if (!fully_driven(source)) return Status::invalid_input;
    constexpr double weight[3] = {1, 4, 1};
    Changes changes;
    Reaction r;
    for (int k = 0; k < 3; ++k) {
      const double tau = 0.5 * k * h;
      if (k > 0) {
        for_each<Source, Size::coordinates>(source.tables.coordinates,
                                            [&](int j) SLIDEWAY_FOLD { y.q[j] += 0.5 * h * y.v[j]; });
        const Status placed =
            Projection<Source>(source, setting.inputs, tau, y.q, y.v).onto_constraints(setting.t + tau, nullptr);
        if (placed != Status::ok) return placed;
      }
      const Modes before = m;
      m.decided = false;  // speeds are known: they alone tell
      const double position = setting.report.drift_position, velocity = setting.report.drift_velocity;
      const Status status = setting.evaluate(tau, y, Aim::decide, true, m, r);
      if (status != Status::ok) return status;
      m.decided = true;
      compare(before.mode, before.sign, k > 0 || state.decided, m, changes);
      add(setting.report.energy, weight[k] * (h / 6), r.power);
      if (k == 0) continue;
      setting.report.drift_position = position;
      setting.report.drift_velocity = velocity;
    }
    setting.report.unlocated_events = count(changes);
    return Status::ok;
  }
};

// Outside the class, so that a program can compile them once: `extern template class BasicStepper<...>`.

template <class Source>
Report BasicStepper<Source>::step(State& state, double dt, const Inputs& inputs) const noexcept {
  Report report;
  const bool same_dt = dt == state.dt;
  const double start = same_dt ? state.start : state.time();
  const long long steps = same_dt ? state.steps : 0;
  const double t = start + static_cast<double>(steps) * dt;
  if (!source.sound || !(dt > 0) || !detail::finite(t) || !(theta >= 0 && theta <= 1) || max_events > Report::room) {
    report.status = Status::invalid_input;
    return report;
  }
  Phase y;
  Modes m;
  begin(state, y, m);
  const Solving how = solving();
  const Setting setting{source, how, inputs, t, report};
  report.status = advance(setting, dt, state, y, m);
  if (!is_located(method) && turns_far(source, state.q, y.q)) ++report.unlocated_events;
  // Rates are what moreau imposes, at q_m: turned to another pose they would spare the next step its impulse.
  if (report.status == Status::ok && stabilise == Stabilise::projection && method != Method::kinematic) {
    report.status =
        Projection<Source>(source, inputs, dt, y.q, y.v).onto_constraints(t + dt, m.mode, method != Method::moreau);
  }
  const double flow = report.energy.work + report.energy.dissipated + report.energy.constraint_work;
  if (report.status == Status::ok && !finite(y.q, y.v, flow)) report.status = Status::inaccurate;
  if (report.status == Status::ok && !(report.drift_position <= drift_limit * source.tables.length)) {
    report.status = Status::drift_limit;
  }
  if (report.status != Status::ok) {
    if (!finite(state, inputs)) report.status = Status::invalid_input;
    return report;
  }
  finish(y, m, state);
  state.start = start;
  state.dt = dt;
  state.steps = steps + 1;
  return report;
}

template <class Source>
Report BasicStepper<Source>::reaction(const State& state, const Inputs& inputs, Reaction& r) const noexcept {
  Report report;
  if (!source.sound || !detail::finite(state.time())) {
    report.status = Status::invalid_input;
    return report;
  }
  Phase y;
  Modes m;
  begin(state, y, m);
  const Solving how = solving();
  const Setting setting{source, how, inputs, state.time(), report};
  report.status = method == Method::moreau && state.dt > 0 ? impulse(setting, state.dt, y, m, r)
                                                           : setting.evaluate(0, y, Aim::decide, true, m, r);
  if (report.status == Status::ok && !(report.drift_position <= drift_limit * source.tables.length)) {
    report.status = Status::drift_limit;
  }
  if (report.status != Status::ok && !finite(state, inputs)) report.status = Status::invalid_input;
  return report;
}

template <class Source>
Report BasicStepper<Source>::project(State& state, const Inputs& inputs) const noexcept {
  Report report;
  State next = state;
  report.status = source.sound && finite(state, inputs)
                      ? Projection<Source>(source, inputs, 0, next.q, next.v).onto_constraints(next.time(), nullptr)
                      : Status::invalid_input;
  if (report.status == Status::ok && !finite(next.q, next.v)) report.status = Status::no_convergence;
  if (report.status == Status::ok) state = next;
  return report;
}

/// Steps a scene that the compiler knows. The scene is a constexpr variable at namespace scope.
template <const auto& scene>
using Stepper = BasicStepper<CompileTime<scene>>;

/// Steps a scene that is known when the program runs; keeps a copy of it.
template <class Size>
using RunTimeStepper = BasicStepper<RunTime<Size>>;

}  // namespace slideway
