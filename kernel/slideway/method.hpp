// The methods of stepping, by name.
#pragma once

namespace slideway {

enum class Method : unsigned char {
  euler,           ///< semi-implicit: v, then q with the new v; order 1
  rk4,             ///< classical Runge-Kutta with an HLCP in every stage (WWZ14); order 4 between events
  rk4_located,     ///< the same with modes frozen within a step and events located; order 4 across them
  dop853_located,  ///< likewise by Dormand and Prince's method of order 8
  moreau,          ///< velocities and impulses, set-valued; order 1; goes on where accelerations have no solution
  kinematic        ///< fully driven scenes: positions solved, not integrated; an HLCP for the reactions
};

inline constexpr Method methods[] = {Method::euler,          Method::rk4,    Method::rk4_located,
                                     Method::dop853_located, Method::moreau, Method::kinematic};

constexpr bool is_located(Method method) noexcept {
  return method == Method::rk4_located || method == Method::dop853_located;
}

constexpr const char* name(Method method) noexcept {
  switch (method) {
    case Method::euler:
      return "euler";
    case Method::rk4:
      return "rk4";
    case Method::rk4_located:
      return "rk4_located";
    case Method::dop853_located:
      return "dop853_located";
    case Method::moreau:
      return "moreau";
    case Method::kinematic:
      return "kinematic";
  }
  return "unknown";
}

/// What keeps the constraints from drifting.
enum class Stabilise : unsigned char {
  baumgarte,  ///< Phi'' + alpha Phi' + beta Phi = 0
  projection  ///< positions and velocities moved onto the constraints after each step
};

}  // namespace slideway
