// What can go wrong, each with the one sentence that the command prints.
#pragma once

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "slideway tests its results with std::isfinite, which -ffast-math turns into 'true': build without it"
#endif

namespace slideway {

enum class Status : unsigned char {
  ok,
  invalid_input,
  singular_constraints,
  no_solution,
  not_unique,
  inaccurate,
  drift_limit,
  no_convergence,
  solve_limit,
  event_limit
};

/// What is known of a solution's being the only one, from the strongest statement to the weakest.
enum class Uniqueness : unsigned char {
  certified,    ///< the column W-property is proved: one solution for every right side
  single,       ///< the W-property fails, but every other sign pattern of this very problem is excluded
  motion_only,  ///< the motion is unique, the forces are a choice
  unproven,     ///< none of these
  refuted       ///< a second solution of this very problem is known
};

/// One sentence for a status. No failure; constant time.
constexpr const char* sentence(Status status) noexcept {
  switch (status) {
    case Status::ok:
      return "The step was made and every check on it held.";
    case Status::invalid_input:
      return "A value is not finite, dt is not positive, an option is out of range, the scene has defects, or the "
             "method "
             "does not apply to it.";
    case Status::singular_constraints:
      return "Rank is lost in this pose: constraints are redundant, or a coordinate moves no mass.";
    case Status::no_solution:
      return "No contact forces satisfy the equations: every sign pattern is excluded.";
    case Status::not_unique:
      return "Several sets of contact forces satisfy the equations, and the scene does not say which one acts.";
    case Status::inaccurate:
      return "A result failed its own check: rounding errors exceed their bound.";
    case Status::drift_limit:
      return "The constraints have drifted beyond the limit.";
    case Status::no_convergence:
      return "No position that satisfies the constraints was found near the last one.";
    case Status::solve_limit:
      return "The solver reached its limit of linear solves before it could decide.";
    case Status::event_limit:
      return "One step would span more events than the limit allows.";
  }
  return "Unknown status.";
}

/// The name of a status as in code, JSON and documentation.
constexpr const char* name(Status status) noexcept {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::invalid_input:
      return "invalid_input";
    case Status::singular_constraints:
      return "singular_constraints";
    case Status::no_solution:
      return "no_solution";
    case Status::not_unique:
      return "not_unique";
    case Status::inaccurate:
      return "inaccurate";
    case Status::drift_limit:
      return "drift_limit";
    case Status::no_convergence:
      return "no_convergence";
    case Status::solve_limit:
      return "solve_limit";
    case Status::event_limit:
      return "event_limit";
  }
  return "unknown";
}

/// The name of a kind of uniqueness as in code, JSON and documentation.
constexpr const char* name(Uniqueness uniqueness) noexcept {
  switch (uniqueness) {
    case Uniqueness::certified:
      return "certified";
    case Uniqueness::single:
      return "single";
    case Uniqueness::refuted:
      return "refuted";
    case Uniqueness::unproven:
      return "unproven";
    case Uniqueness::motion_only:
      return "motion_only";
  }
  return "unknown";
}

}  // namespace slideway
