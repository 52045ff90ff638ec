// Accelerations and all forces of one instant, or of the mean over a step: modes, contact forces, and what follows.
#pragma once

#include <slideway/self_check.hpp>

namespace slideway {

/// The caller's choices that an evaluation follows.
struct Solving {
  Gains gains;       ///< Baumgarte's; a stepper starts with its scene's
  HlcpOptions hlcp;  ///< what to do with several solutions, and how long to search
};

/// The weaker of two statements about uniqueness.
constexpr Uniqueness weaker(Uniqueness a, Uniqueness b) noexcept { return a > b ? a : b; }

/// Terms of a point's velocity on body i, at rho from its origin, m/s.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double speed_terms(const Source& source, const Kinematics<Size>& k, int i, Vec2 rho) noexcept {
  if (i == ground) return 0;
  double terms = source.tables.moving[i] ? std::fabs(k.velocity[i].x) + std::fabs(k.velocity[i].y) : 0;
  if (source.tables.turning[i]) terms += std::fabs(k.rate[i]) * (std::fabs(rho.x) + std::fabs(rho.y));
  return terms;
}

/// Is the sliding speed zero to rounding? |T q'| <= 4 eps ((coordinates + 1) sum_j |q'_j| size_j + the velocities whose
/// difference it is), where size_j is what a column of T is made of: 1 for a slide, for a turn the places whose
/// difference is its lever. Each carries a rounding for each body on its path. Loops give 1e-17 where they should give
/// 0, and so does what slider and rail have in common.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool at_rest(const Source& source, const Work<Size>& w, int g, const double* v, double slip) noexcept {
  const auto& table = source.tables;
  const Link<Size>& link = table.guide[g];
  const Sliding& s = w.friction.sliding[g];
  double terms = 0;
  for_each<Source, Size::coordinates>(link.columns, [&](int c) SLIDEWAY_FOLD {
    const int j = link.column[c];
    const Vec2 origin = w.kinematics.origin[table.body_of[j]];
    const double lever = std::fabs(s.place.x) + std::fabs(s.place.y) + std::fabs(origin.x) + std::fabs(origin.y);
    terms += std::fabs(v[j]) * (table.motion[j] == Motion::turn ? lever : 1);
  });
  const Guide& guide = source.scene.guide[g];
  const double common = speed_terms(source, w.kinematics, guide.slider, s.on_slider) +
                        speed_terms(source, w.kinematics, guide.rail, s.on_rail);
  return std::fabs(slip) <= 4 * detail::epsilon * ((link.columns + 1) * terms + common);
}

/// What roundings of q and v make of the right sides -alpha Phi' - beta Phi: Phi is a difference of places, each
/// rounded four halves of an eps a body, Phi' of their velocities. m/s^2
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double state_rounding(const Source& source, const double* v, Gains gains) noexcept {
  const auto& table = source.tables;
  double speed = 0;
  for_each<Source, Size::coordinates>(table.coordinates, [&](int j) SLIDEWAY_FOLD {
    speed += table.motion[j] == Motion::turn ? table.length * std::fabs(v[j]) : std::fabs(v[j]);
  });
  return 4 * detail::epsilon * (source.scene.bodies + 1) *
         (std::fabs(gains.beta) * table.length + std::fabs(gains.alpha) * speed);
}

/// Squared distance of the row of rough contact c, i in its problem, from that of its guide's other contact: forces of
/// two contacts close to each other are rounding divided by that.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE double own_part(const Source& source, const Problem<Source>& hlcp, int i, int c, double norm) noexcept {
  const int g = source.tables.guide_of[c];
  if (Size::contacts < 2 || source.scene.guide[g].contacts != 2) return norm * norm;
  const int o = c == source.tables.first_contact[g] ? i + 1 : i - 1;
  const double shared = 0.5 * (hlcp.plus[i][o] + hlcp.minus[i][o]), other = 0.5 * (hlcp.plus[o][o] + hlcp.minus[o][o]);
  return larger(norm * norm - detail::quotient(shared * shared, other), detail::epsilon * norm * norm);
}

/// What an evaluation is for.
enum class Aim : unsigned char {
  decide,  ///< modes and signs are found: an HLCP; the set-valued law where guides are at rest
  follow,  ///< modes and signs are kept, right or wrong: one linear solve
  impulse  ///< means over a step to come: rates at its end are prescribed, and every guide is set-valued in them
};

/// Where and how an evaluation is made.
template <class Size>
struct Moment {
  double t, tau;  ///< time; since the step's start, for live inputs
  const double *q, *v;
  const Inputs<Size>& inputs;
  Aim aim;
  bool at_start;     ///< drift is measured, and a guide whose sliding speed is all rounding counts as at rest
  double dt = 0;     ///< of the step, for impulses: gains are then {1 / dt, c / dt, 0}
  double ahead = 0;  ///< from t to the step's end
};

/// Which rough guides are at rest, and the modes of the others. Returns whether there is one.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE bool find_rest(const Source& source, const Work<Size>& w, const Moment<Size>& at, Modes<Size>& m,
                               const Reaction<Size>& r, bool* rests) noexcept {
  bool any = false;
  for_each<Source, Size::guides>(source.scene.guides, [&](int g) SLIDEWAY_FOLD {
    rests[g] = false;
    if (!source.tables.is_rough[g]) return;
    if (at.aim == Aim::follow) {
      rests[g] = m.mode[g] == 0;
    } else if (at.aim == Aim::impulse) {
      rests[g] = true;
      m.leaving[g] = m.decided ? m.mode[g] != 0 : !at_rest(source, w, g, at.v, r.slip[g]);
    } else {
      const bool still = m.still[g] || (at.at_start && at_rest(source, w, g, at.v, r.slip[g]));
      rests[g] = still || (m.decided && m.mode[g] == 0);
      if (!rests[g] && r.slip[g] != 0) m.mode[g] = r.slip[g] > 0 ? 1 : -1;
    }
    if (rests[g] && (at.aim == Aim::impulse || !m.decided)) m.mode[g] = 0;
    any = any || rests[g];
  });
  return any;
}

/// For impulses: the mean acceleration that brings each driven coordinate's speed to its law's at the step's end, but
/// for -(beta / alpha) phi.
template <class Source, class Size = typename Source::Size>
void prescribe_means(const Source& source, const Moment<Size>& at, const Solving& solving, Work<Size>& w,
                     Reaction<Size>& r) noexcept {
  for (int d = 0; d < source.scene.drives; ++d) {
    const Drive& drive = source.scene.drive[d];
    const int j = source.tables.first[drive.body] + drive.axis;
    const LawValue now = law_at(drive, at.t, at.inputs.input, at.tau);
    const LawValue end = law_at(drive, at.t + at.ahead, at.inputs.input, at.tau + at.ahead);
    const double phi = at.q[j] - now.value;
    w.prescribed[j] = solving.gains.alpha * (end.rate - at.v[j]) - solving.gains.beta * phi;
    r.drift_position = larger(r.drift_position, std::fabs(phi));
    r.drift_velocity = larger(r.drift_velocity, std::fabs(at.v[j] - now.rate));
  }
}

/// Prescribed accelerations, kinematics and contacts.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void place(const Source& source, const Moment<Size>& at, const Solving& solving, Work<Size>& w,
                           Reaction<Size>& r) noexcept {
  r.t = at.t;
  r.drift_position = r.drift_velocity = 0;
  if (at.aim == Aim::impulse) {
    prescribe_means(source, at, solving, w, r);
  } else {
    prescribe(source, at.q, at.v, at.t, at.inputs, at.tau, solving.gains, w.prescribed, r.drift_position,
              r.drift_velocity);
  }
  kinematics(source, at.q, at.v, w.prescribed, w.kinematics);
  place_contacts(source, w.kinematics, solving.gains, at.at_start, w.friction, r);
}

/// For impulses: kinematics and contacts again, with the drives' speeds as they are to be at the step's end and the
/// others as before, so that rates of constraints at the end are these plus dt times what the mean accelerations add.
template <class Source, class Size = typename Source::Size>
[[gnu::noinline]] void place_ahead(const Source& source, const Moment<Size>& at, const Solving& solving, Work<Size>& w,
                                   Reaction<Size>& r) noexcept {
  double v[at_least_one(Size::coordinates)];
  for (int j = 0; j < source.tables.coordinates; ++j) {
    v[j] = source.tables.free_of[j] != none ? at.v[j] : at.v[j] + at.dt * w.prescribed[j];
  }
  kinematics(source, at.q, v, w.prescribed, w.kinematics);
  place_contacts(source, w.kinematics, solving.gains, false, w.friction, r);
}

/// For impulses: rates and powers at the step's end, where friction opposes the slip.
template <class Source, class Size = typename Source::Size>
[[gnu::noinline]] void place_at_end(const Source& source, const Moment<Size>& at, const Solving& solving, Work<Size>& w,
                                    Reaction<Size>& r) noexcept {
  double v[at_least_one(Size::coordinates)];
  for (int j = 0; j < source.tables.coordinates; ++j) v[j] = at.v[j] + at.dt * r.acceleration[j];
  kinematics(source, at.q, v, w.prescribed, w.kinematics);
  place_contacts(source, w.kinematics, solving.gains, false, w.friction, r);
  for (int p = 0; p < source.scene.pins; ++p) meeting(source, w.kinematics, p, w.friction.meeting[p]);
  apply_forces(source, w.kinematics, at.inputs, at.tau, w.dynamics);
  for (int s = 0; s < source.scene.joint_springs; ++s) {
    const JointSpring& spring = source.scene.joint_spring[s];
    const double rate = v[source.tables.first[spring.body]];
    w.dynamics.damper_power += spring.damping * rate * rate;
  }
  measure_power(source, v, w, r);
  for (int g = 0; g < source.scene.guides; ++g) {  // `steady` is of the speeds at the start, as the dampers' forces are
    if (!source.tables.is_steady[g] || w.friction.held[g]) continue;
    r.power.dissipated += (w.friction.steady[g] + source.scene.guide[g].viscous * r.slip[g]) * r.slip[g];
  }
}

/// Solves at most, until contact forces have the signs that they were solved with: two suffice where one was rounding.
inline constexpr int signs_rounds = 4;

/// A part with guides at rest: their modes if they are to be decided, its contact forces and stiction.
template <class Source, class Size = typename Source::Size>
[[gnu::noinline]] Status hold(const Source& source, int part, const Moment<Size>& at, const Solving& solving,
                              const bool* rests, Work<Size>& w, Problem<Source>& hlcp, Modes<Size>& m,
                              Reaction<Size>& r, Report& report) noexcept {
  const auto& table = source.tables;
  Friction<Size>& fr = w.friction;
  const int rows = row_count(table, part);
  const Index* contact = table.rough_contact + table.first_row[part];
  each_guide_in_part(source, part, [&](int g) {  // the sliding problem leaves alone what a row does not reach
    each_in_part(source, part, [&](int f) {
      if (!table.guide[g].filled[f]) fr.N[g][f] = fr.T[g][f] = fr.E[g][f] = 0;
    });
  });
  RestProblem<Source> problem(source, part, solving.hlcp, fr, hlcp);
  double slack = 0;
  each_guide_in_part(source, part, [&](int g) {
    if (!rests[g]) return;
    const Guide& guide = source.scene.guide[g];
    const double gamma = solving.gains.known * sliding_gamma(source, w.kinematics, g, fr.sliding[g]);
    const bool kinetic = m.mode[g] != 0 || m.leaving[g];
    problem.add(g, -gamma - solving.gains.alpha * r.slip[g], kinetic ? guide.mu : guide.mu_static);
    slack = larger(slack, solving.gains.alpha * std::fabs(r.slip[g]));
  });
  problem.allow(4 * slack, state_rounding(source, at.v, solving.gains));
  if (at.aim != Aim::follow) {
    const Uniqueness others = report.uniqueness;  // of the parts before
    report.uniqueness = Uniqueness::certified;
    const Status status = problem.decide(m, report);
    const bool refuted = report.uniqueness == Uniqueness::refuted;
    report.uniqueness = weaker(report.uniqueness, others);
    if (status != Status::ok || refuted) {
      bool named = false;
      each_guide_in_part(source, part, [&](int g) {
        if (rests[g] && !named) report.guide = g;
        named = named || rests[g];
      });
    }
    if (status != Status::ok) return independent_contacts(hlcp, rows) ? status : Status::singular_constraints;
  }
  // Signs were decided beside unknowns as large as preloads, and are rounding where contact forces are below that: the
  // forces found in the mode have the last word. Their sign counts for guides that slip, so they are solved for again.
  bool contradicted = true;
  for (int round = 0; round < signs_rounds && contradicted; ++round) {
    if (!problem.solve_in_mode(m, r.lambda)) return Status::singular_constraints;
    contradicted = false;
    for (int i = 0; i < rows && at.aim != Aim::follow; ++i) {
      const int c = contact[i], g = table.guide_of[c];
      const signed char sign = r.lambda[c] < 0 ? -1 : 1;
      if (sign == m.sign[c]) continue;
      contradicted = contradicted || !rests[g] || m.mode[g] != 0;
      m.sign[c] = sign;
    }
  }
  signed char sign[at_least_one(most_rows<Source>)] = {};
  for (int i = 0; i < rows; ++i) sign[i] = m.sign[contact[i]];
  if (at.aim != Aim::follow && !has_digits(hlcp, rows, sign)) return Status::singular_constraints;
  double largest = 0;
  for (int i = 0; i < rows; ++i) {
    fr.face[contact[i]] = m.sign[contact[i]] < 0 ? -1 : 1;
    largest = larger(largest, std::fabs(r.lambda[contact[i]]));
  }
  bool within = true;
  each_guide_in_part(source, part, [&](int g) {
    if (!rests[g] || m.mode[g] != 0) return;
    m.limit_left[g] = problem.limit_left(g, r.lambda);
    // 2^-40: some thousand roundings of the largest force.
    within = within && m.limit_left[g] >= -0x1p-40 * (largest + std::fabs(fr.stiction[g]));
  });
  return within || at.aim == Aim::follow ? Status::ok : Status::inaccurate;
}

/// The guide to name where friction leaves a part no or several answers: the first without whose friction there is one;
/// else the first. Cost: an HLCP a guide, of a step that is refused or goes on along the signs.
template <class Source>
[[gnu::noinline, gnu::cold]] int guide_to_blame(const Source& source, int part, const Problem<Source>& hlcp) noexcept {
  const auto& table = source.tables;
  const int rows = row_count(table, part);
  int blamed = none;
  each_guide_in_part(source, part, [&](int g) {
    if (blamed != none) return;
    Problem<Source> without = hlcp;
    for (int i = 0; i < rows; ++i) {
      for (int k = 0; k < source.scene.guide[g].contacts; ++k) {
        const int j = table.row_of[table.first_contact[g]] + k;
        without.plus[i][j] = without.minus[i][j] = 0.5 * (hlcp.plus[i][j] + hlcp.minus[i][j]);
      }
    }
    HlcpSolution<at_least_one(most_rows<Source>)> answer = {};
    solve(without, rows, answer);
    if (answer.status == Status::ok) blamed = g;
  });
  return blamed != none ? blamed : table.rough_guide[table.first_guide[part]];
}

/// How many rough contacts a part has, as a std::integral_constant where the compiler knows and one part has them all.
template <class Source>
SLIDEWAY_INLINE auto rows_of(const Source& source, int part) noexcept {
  if constexpr (Source::folds) {
    if constexpr (Source::tables.most_rows == Source::tables.rough) {
      return std::integral_constant<int, Source::tables.rough>{};
    } else {
      return row_count(source.tables, part);
    }
  } else {
    return row_count(source.tables, part);
  }
}

/// The contact forces of a part where all guides slip.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE Status press(const Source& source, int part, Aim aim, const Solving& solving, Problem<Source>& hlcp,
                             Modes<Size>& m, Friction<Size>& fr, Reaction<Size>& r, Report& report) noexcept {
  HlcpSolution<at_least_one(most_rows<Source>)> answer;
  each_row_in_part(source, part, [&](int i, int c) SLIDEWAY_FOLD { answer.sign[i] = m.sign[c]; });
  const auto rows = rows_of(source, part);
  if (aim == Aim::follow) {
    if (!solve_with_signs(hlcp, rows, answer.sign, answer.x)) return Status::singular_constraints;
  } else {
    solve(hlcp, rows, answer, solving.hlcp);
    report.solves = report.solves > answer.solves ? report.solves : answer.solves;
    report.uniqueness = weaker(report.uniqueness, answer.uniqueness);
    if (answer.uniqueness == Uniqueness::refuted || answer.status == Status::no_solution) {
      const bool outweighs = report.guide == none || answer.status == Status::no_solution;
      if (outweighs) report.guide = guide_to_blame(source, part, hlcp);
    }
    if (answer.status != Status::ok) {
      return independent_contacts(hlcp, rows) ? answer.status : Status::singular_constraints;
    }
    if (!answer.bounded) {
      const auto signs = answer;  // a copy, so that the answer itself can stay in registers
      if (!has_digits(hlcp, rows, signs.sign)) return Status::singular_constraints;
    }
  }
  each_row_in_part(source, part, [&](int i, int c) SLIDEWAY_FOLD {
    r.lambda[c] = answer.x[i];
    m.sign[c] = answer.sign[i];
    fr.face[c] = answer.sign[i] < 0 ? -1 : 1;
  });
  return Status::ok;
}

/// Rows, problem and contact forces of one part.
template <bool all_slip, class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE Status solve_part(const Source& source, int part, const Moment<Size>& at, const Solving& solving,
                                  const bool* rests, Work<Size>& w, Modes<Size>& m, Reaction<Size>& r,
                                  Report& report) noexcept {
  // Apart from `w`: what a call that is not inlined may see is not kept in registers.
  Problem<Source> hlcp;
  if (!assemble_part(source, w.kinematics, w.dynamics, part, w.friction, hlcp)) return Status::singular_constraints;
  bool any_rests = false;
  if (!all_slip) each_guide_in_part(source, part, [&](int g) { any_rests = any_rests || rests[g]; });
  const Status status = any_rests ? hold(source, part, at, solving, rests, w, hlcp, m, r, report)
                                  : press(source, part, at.aim, solving, hlcp, m, w.friction, r, report);
  each_row_in_part(source, part, [&](int i, int c) SLIDEWAY_FOLD {
    m.norm[c] = w.friction.norm[c];
    m.own[c] = own_part(source, hlcp, i, c, m.norm[c]);
  });
  return status;
}

/// accelerate() without guides at rest, or with. Two functions, because what holds a guide at rest is not inlined, and
/// what it may see cannot be kept in registers. The first gives up, and says so, where it finds a guide at rest.
template <bool all_slip, class Source, class Size = typename Source::Size>
[[gnu::noinline]] Status evaluate(const Source& source, const Moment<Size>& at, const Solving& solving, Modes<Size>& m,
                                  Reaction<Size>& __restrict r, Report& __restrict report, bool& any_rests) noexcept {
  const auto& scene = source.scene;
  const auto& table = source.tables;
  Work<Size> w;
  SLIDEWAY_ASSUME(!all_slip || at.aim != Aim::impulse);
  place(source, at, solving, w, r);
  bool rests[at_least_one(Size::guides)];
  any_rests = find_rest(source, w, at, m, r, rests);
  if (all_slip && any_rests) return Status::ok;
  signed char slips[at_least_one(Size::guides)] = {};
  for_each<Source, Size::guides>(scene.guides, [&](int g) SLIDEWAY_FOLD { slips[g] = rests[g] ? 0 : m.mode[g]; });
  apply_forces(source, w.kinematics, at.inputs, at.tau, w.dynamics);
  apply_steady_friction(source, slips, w.friction, w.dynamics);
  gather(source, w.kinematics, w.dynamics);
  if (!factor_mass(source, w.kinematics, at.q, at.v, w.dynamics)) return Status::singular_constraints;
  if (!all_slip && at.aim == Aim::impulse) place_ahead(source, at, solving, w, r);
  if (!assemble(source, w.kinematics, w.dynamics, solving.gains, slips, w.friction, r)) {
    return Status::singular_constraints;
  }

  signed char signs[at_least_one(Size::contacts)] = {};
  for_each<Source, Size::contacts>(table.contacts, [&](int c) SLIDEWAY_FOLD { signs[c] = m.sign[c]; });
  Status status = Status::ok;
  for_each<Source, Size::coordinates>(table.parts, [&](int part) SLIDEWAY_FOLD {
    // Several answers of one part say nothing of the others: another may have none.
    if (status != Status::ok && status != Status::not_unique) return;
    if (row_count(table, part) == 0) return;
    const Status solved = solve_part<all_slip>(source, part, at, solving, rests, w, m, r, report);
    if (solved != Status::ok) status = solved;
  });
  if (status != Status::ok) return status;
  resolve(source, r, w);
  for_each<Source, Size::contacts>(table.contacts, [&](int c) SLIDEWAY_FOLD {
    if (!table.is_rough[table.guide_of[c]]) r.lambda[c] = w.pi[table.row_of[c]];
  });
  for_each<Source, Size::pins>(scene.pins, [&](int p) SLIDEWAY_FOLD { r.pin[p] = {w.pi[2 * p], w.pi[2 * p + 1]}; });
  if (!resolved(source, w)) return Status::singular_constraints;
  m.rounding = rank_bound(source) * w.scale;
  m.state_rounding = state_rounding(source, at.v, solving.gains);
  for_each<Source, Size::contacts>(table.rough, [&](int i) SLIDEWAY_FOLD {
    const int c = table.rough_contact[i];
    // Rounding has no face of its own.
    const double noise = m.rounding * m.norm[c] + m.state_rounding;  // times m.own
    if (m.decided && std::fabs(r.lambda[c]) * m.own[c] <= noise) m.sign[c] = signs[c];
  });
  from_metric(source, w.dynamics, w.u);
  for_each<Source, Size::coordinates>(table.coordinates, [&](int j) SLIDEWAY_FOLD {
    r.acceleration[j] = table.free_of[j] != none ? w.u[table.free_of[j]] : w.prescribed[j];
  });

  for_each<Source, Size::guides>(scene.guides, [&](int g) SLIDEWAY_FOLD {
    w.friction.held[g] = rests[g] && (m.mode[g] == 0 || at.aim != Aim::impulse);
  });
  const bool opposes = rub(source, w.friction, rests, r) || at.aim == Aim::follow;
  double residual = check(source, w, r);
  if (!all_slip && at.aim == Aim::impulse) {
    place_at_end(source, at, solving, w, r);
  } else {
    measure_power(source, at.v, w, r);
  }
  const double power = r.power.work + r.power.dissipated + r.power.constraint_work;
  residual += power - power;  // 0, or NaN where a force or its power is not finite
  report.residual = residual > report.residual ? residual : report.residual;
  if (at.at_start) {
    report.drift_position = r.drift_position;
    report.drift_velocity = r.drift_velocity;
  }
  return opposes && residual <= residual_bound(source) ? Status::ok : Status::inaccurate;
}

/// q'', contact forces, friction, pin and drive forces at (t, q, v), checked (WWZ14 (10)-(19)).
///
/// m, in and out: modes and contact signs, first guesses and then the answer's, unless they are to be followed. r is
/// valid only when the status is ok. `report` keeps the extremes of all calls. Cost: one HLCP (follow: one linear
/// solve) and O(bodies + contacts^2); with guides at rest, up to 2 guides + 2 larger HLCPs.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE Status accelerate(const Source& source, const Moment<Size>& at, const Solving& solving, Modes<Size>& m,
                                  Reaction<Size>& __restrict r, Report& __restrict report) noexcept {
  ++report.evaluations;
  bool any_rests = at.aim == Aim::impulse;
  if (!any_rests) {
    const Status status = evaluate<true>(source, at, solving, m, r, report, any_rests);
    if (!any_rests) return status;
  }
  return evaluate<false>(source, at, solving, m, r, report, any_rests);
}

}  // namespace slideway
