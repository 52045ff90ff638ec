// The floor: one RK4 step of crank_rocker_offset, derived by hand for this mechanism alone. It is what the kernel's
// compile-time step is measured against, so it does everything that the result needs (an HLCP in every stage, Baumgarte
// with gains known at run time, friction against the sliding speed of every stage, a test that the result is finite)
// and nothing that checks it (no residual, no certificate).
//
// Derivation. u(x) = (cos x, sin x); g gravity; a half the block's length.
//
// Coordinates: A the rocker's angle, B the crank's, C the block's, all absolute. Rocker about O1 = (0, 0), crank about
// O2 = (0, 1), block's centre of mass at the crank's tip p = O2 + L u(B), so that the mass matrix is diagonal and
// constant:
//
//     diag(J_A, J_B, J_C),   J_B with the block's mass at the tip
//
// The step integrates A, beta = B - A and gamma = C - A instead. That is a constant linear change of coordinates, under
// which a Runge-Kutta step is the same step, and these are the angles that the guide sees. The rail's t = u(A), n its
// normal, d its distance from O1. Contact k is at r_k = p + e_k u(C), e_1 = -a, e_2 = +a. With
//
//     P = t . p = sin A + L cos beta,     Q = n . p = cos A + L sin beta,     s = sin gamma,  c = cos gamma
//
// the constraints are Phi_k = Q + e_k s - d, that is Phi_k = Phi_0 + e_k s with
//
//     Phi_0  = cos A + L sin beta - d
//     Phi_0' = -sin A A' + L cos beta beta'
//     Phi_0'' = -sin A A'' + L cos beta beta'' - (cos A A'^2 + L sin beta beta'^2)
//             = -P A'' + L cos beta B'' - (cos A A'^2 + L sin beta beta'^2)
//     s'' = c gamma'' - s gamma'^2
//
// Baumgarte on both Phi_k is Baumgarte on their mean Phi_0 and on their difference s. The latter gives gamma'' before
// any force is known:
//
//     gamma'' = (gamma'^2 - b_g) s / c - a_g gamma'                       (gains: alpha = a_g, beta = b_g)
//
// Rows in (A, B, C), normal and sliding, at the coincident points of slider and rail:
//
//     N_k = (-P - e_k c,  L cos beta,  e_k c),    T_k = (Q + e_k s,  -L sin beta,  -e_k s)
//     T_k q' = v_0 - e_k s gamma',                v_0 = A' cos A - L sin beta beta'
//
// Friction -mu sgn(T_1 q') |lambda_k| = -nu_k lambda_k on the slider, nu_k = mu sgn(T_1 q') sgn(lambda_k). In multiples
// of J = J_A + J_C, x_k = lambda_k / J, with rho = J / J_B, C'' = A'' + gamma'' and the sum of the rows A and C:
//
//     A'' = A_0 - sum p_k x_k,         p_k = P + nu_k Q,                      A_0 = (load_A - J_C gamma'') / J
//     B'' = B_0 + rho sum r_k x_k,     r_k = L cos beta + nu_k L sin beta,    B_0 = load_B / J_B
//     J_C C'' = J a (w_2 x_2 - w_1 x_1),   w_k = c + nu_k s
//
// Into Baumgarte for Phi_0 and into the last line: the HLCP (S + S_star D) x = b of this mechanism, D = diag(sgn x),
// after row operations that do not depend on D:
//
//     sum_k (P p_k + L cos beta rho r_k) x_k = b,     w_2 x_2 - w_1 x_1 + kappa sum_k p_k x_k = kappa (A_0 + gamma'')
//     b = P A_0 - L cos beta B_0 + (cos A A'^2 + L sin beta beta'^2) - a_g Phi_0' - b_g Phi_0,    kappa = J_C / (J a)
//
// Contacts that press on the same face have one nu, p, r and w: the first row is then one equation for x = x_1 + x_2,
// all that the motion needs, and the second says with y = x_2 - x_1 = kappa C'' / w whether the signs were right:
// sgn(x_k) = sgn(x) for both <=> |y| <= |x|.

#ifndef FLOOR_CRANK_ROCKER_HPP
#define FLOOR_CRANK_ROCKER_HPP

#include <cmath>

namespace floor_crank_rocker {

/// Coordinates of the scene: rocker, crank, block relative to the crank (rad), and their rates (rad/s).
struct State3 {
  double q[3];
  double v[3];
};

/// Phi'' + alpha Phi' + beta Phi = 0; 1/s, 1/s^2.
struct Gains {
  double alpha;
  double beta;
};

/// Signs of the contact forces, +1 or -1: where the next sign iteration starts.
struct Signs {
  double first;
  double second;
};

constexpr double kGravity = 9.81;                           // m/s^2, along -y
constexpr double kMu = 0.2;                                 // kinetic
constexpr double kCrank = 0.5;                              // L, m: O2 to the block's pivot
constexpr double kOffset = 0.1;                             // d, m: O1 to the rail's line
constexpr double kHalfLength = 0.05;                        // a, m
constexpr double kRockerMoment = 4.0 * 1.0;                 // kg m: mass times distance of the centre of mass from O1
constexpr double kCrankMoment = 2.0 * 0.25 + 0.5 * kCrank;  // kg m: the same of crank and block about O2
constexpr double kRockerInertia = 16.0 / 3.0;               // J_A, kg m^2, about O1
constexpr double kCrankInertia = 1.0 / 6.0 + 0.5 * (kCrank * kCrank);   // J_B, kg m^2, about O2, with the block's mass
constexpr double kBlockInertia = 1e-3;                                  // J_C, kg m^2
constexpr double kInertia = kRockerInertia + kBlockInertia;             // J
constexpr double kRho = kInertia / kCrankInertia;                       // J / J_B
constexpr double kKappa = kBlockInertia / (kInertia * kHalfLength);     // kappa, 1/m
constexpr double kRockerFall = kGravity * kRockerMoment / kInertia;     // 1/s^2
constexpr double kCrankFall = kGravity * kCrankMoment / kCrankInertia;  // 1/s^2
constexpr int kMaxSolves = 4;  // the patterns of two signs; the iteration meets none twice where the HLCP is unique

inline void sin_cos(double x, double& sin, double& cos) noexcept {
#ifdef __GLIBC__
  ::sincos(x, &sin, &cos);
#else
  sin = std::sin(x);
  cos = std::cos(x);
#endif
}

/// The angles A, beta, gamma, or their rates, or their accelerations.
struct Angles {
  double A, beta, gamma;
};

/// What the HLCP of a stage consists of (see above): lc = L cos beta, ls = L sin beta, mu = mu sgn(T_1 q').
struct Contact {
  double P, lc, c, A0, Q, ls, s, B0, mu, b, gamma_accel;
};

/// Sign iteration from any signs: A'', beta'', gamma'', and the signs found; not a number when it does not end. Out of
/// line, for almost every stage ends before it.
[[gnu::noinline, gnu::cold]] inline Angles solve_any_signs(const Contact& k, Signs& signs) noexcept {
  for (int solves = 0; solves < kMaxSolves; ++solves) {
    const double nu1 = k.mu * signs.first, nu2 = k.mu * signs.second;
    const double p1 = k.P + nu1 * k.Q;
    const double p2 = k.P + nu2 * k.Q;
    const double r1 = kRho * (k.lc + nu1 * k.ls);
    const double r2 = kRho * (k.lc + nu2 * k.ls);
    const double a11 = k.P * p1 + k.lc * r1, a12 = k.P * p2 + k.lc * r2;
    const double a21 = kKappa * p1 - (k.c + nu1 * k.s), a22 = kKappa * p2 + (k.c + nu2 * k.s);
    const double b2 = kKappa * (k.A0 + k.gamma_accel);
    const double inverse = 1.0 / (a11 * a22 - a12 * a21);
    const double x1 = (k.b * a22 - a12 * b2) * inverse;
    const double x2 = (a11 * b2 - a21 * k.b) * inverse;
    const Signs found{x1 < 0.0 ? -1.0 : 1.0, x2 < 0.0 ? -1.0 : 1.0};
    if (found.first == signs.first && found.second == signs.second) {
      const double A_accel = k.A0 - (p1 * x1 + p2 * x2);
      return {A_accel, k.B0 + (r1 * x1 + r2 * x2) - A_accel, k.gamma_accel};
    }
    signs = found;
  }
  return {std::nan(""), std::nan(""), std::nan("")};
}

/// A'', beta'', gamma'' at q with rates v. signs: of the contact forces; face: their sign when they agree, else 0. Both
/// are where the sign iteration starts and, on return, where it ended.
[[gnu::always_inline]] inline Angles stage(Angles q, Angles v, const Gains& gains, Signs& signs,
                                           double& face) noexcept {
  double sA, cA, sb, cb, s, c;
  sin_cos(q.A, sA, cA);
  sin_cos(q.beta, sb, cb);
  sin_cos(q.gamma, s, c);
  const double lc = kCrank * cb, ls = kCrank * sb;
  const double P = sA + lc, Q = cA + ls;

  const double gamma_accel = (v.gamma * v.gamma - gains.beta) * (s / c) - gains.alpha * v.gamma;
  const double A0 = -kRockerFall * cA - (kBlockInertia / kInertia) * gamma_accel;
  const double B0 = kCrankFall / kCrank * (sA * ls - cA * lc);  // -cos B = sin A sin beta - cos A cos beta

  const double cav = cA * v.A, lsv = ls * v.beta;
  const double mu = std::copysign(kMu, (cav - lsv) + kHalfLength * s * v.gamma);
  // P A_0 last: gamma'' and its division reach b through it alone.
  const double b = (cav + gains.alpha * sA) * v.A + (lsv - gains.alpha * lc) * v.beta - gains.beta * (Q - kOffset) -
                   lc * B0 + P * A0;

  const double nu = mu * face;
  const double p = P + nu * Q, r = kRho * (lc + nu * ls);
  const double x = b / (P * p + lc * r);
  const double A_accel = A0 - p * x;
  // |y| < |x| and sgn x as assumed. Not so with face = 0 or w < 0: solve_any_signs decides.
  if (std::fabs(kKappa * (A_accel + gamma_accel)) < face * x * (c + nu * s)) {
    return {A_accel, B0 + r * x - A_accel, gamma_accel};
  }
  const Angles accel = solve_any_signs({P, lc, c, A0, Q, ls, s, B0, mu, b, gamma_accel}, signs);
  face = 0.5 * (signs.first + signs.second);
  return accel;
}

[[gnu::always_inline]] inline Angles advance(Angles q, double h, Angles v) noexcept {
  return {q.A + h * v.A, q.beta + h * v.beta, q.gamma + h * v.gamma};
}

[[gnu::always_inline]] inline Angles sum(Angles x, Angles y) noexcept {
  return {x.A + y.A, x.beta + y.beta, x.gamma + y.gamma};
}

/// One classical Runge-Kutta step of size h (s). False, and the state as it was, when the result is not finite. The
/// mechanism is undriven: the time does not enter. The signs are those of the last stage.
inline bool floor_step(State3& state, double /*t*/, double h, const Gains& gains, Signs& signs) noexcept {
  const Gains g = gains;
  Signs sign = signs;  // the caller's stay as they are until the result is known to be finite
  double face = 0.5 * (sign.first + sign.second);
  const double half = 0.5 * h;
  const double beta = state.q[1] - state.q[0], beta_rate = state.v[1] - state.v[0];
  const Angles q1{state.q[0], beta, beta + state.q[2]};
  const Angles v1{state.v[0], beta_rate, beta_rate + state.v[2]};

  const Angles a1 = stage(q1, v1, g, sign, face);
  const Angles v2 = advance(v1, half, a1);
  const Angles a2 = stage(advance(q1, half, v1), v2, g, sign, face);
  const Angles v3 = advance(v1, half, a2);
  const Angles a3 = stage(advance(q1, half, v2), v3, g, sign, face);
  const Angles v4 = advance(v1, h, a3);
  const Angles a4 = stage(advance(q1, h, v3), v4, g, sign, face);

  // The weights 1, 2, 2, 1 on the velocities are h^2/6 (a1 + a2 + a3) beside h v.
  const Angles a23 = sum(a2, a3), a123 = sum(a1, a23);
  const Angles q = advance(q1, h, advance(v1, h * (1.0 / 6.0), a123));
  const Angles v = advance(v1, h * (1.0 / 6.0), sum(sum(a123, a23), a4));

  const double any = (q.A + q.beta + q.gamma) + (v.A + v.beta + v.gamma);  // not finite if one of them is not
  if (!std::isfinite(any)) return false;
  state = {{q.A, q.A + q.beta, q.gamma - q.beta}, {v.A, v.A + v.beta, v.gamma - v.beta}};
  signs = sign;
  return true;
}

}  // namespace floor_crank_rocker

#endif  // FLOOR_CRANK_ROCKER_HPP
