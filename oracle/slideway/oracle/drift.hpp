// How far a method lets a mechanism drift off its constraints, before it is run.
//
// Along the exact motion with Baumgarte's terms every constraint obeys Phi'' + alpha Phi' + beta Phi = 0 whatever its
// shape: e = (Phi, Phi') follows e' = A e, A = [[0, 1], [-beta, -alpha]]. A step of a method takes e to
//   e_(k+1) = R e_k + d_k,
// R what the method makes of e' = A e (drift_map) and d_k its defect, which comes from the curvature of the constraint
// and of the motion. With |.| entry by entry, after k steps
//   |e_k| <= |R^k| |e_0| + (sum over j < k of |R^j|) d,   d >= |d_j| for all j.                             (1)
// The sum converges if the spectral radius of R is below 1; where it is 1 (no gains) it grows as it must: by k d' in
// Phi', by k d + h k (k - 1) / 2 d' in Phi. Given d, (1) cannot be improved without knowing the order of the defects.
//
// The bound in a norm, |e_k|_P <= rho^k |e_0|_P + d_P / (1 - rho) with |R|_P = rho < 1, is weaker, term by term, but
// says at what rate a disturbance is forgotten. Critical damping makes A defective, so that no norm of eigenvectors has
// this; |e|_P^2 = e' P e has it for any rho above the spectral radius r if P solves P = Q + (R/rho)' P (R/rho), Q
// positive:
//   |R e|_P^2 = rho^2 (e' P e - e' Q e) < rho^2 |e|_P^2.
// P = sum over j of (R/rho)^j' Q (R/rho)^j, so it is positive too.
//
// d is measured, on steps in exact arithmetic from states that the caller samples the motion at: see defect_margin. So
// the bound is as good as the samples, and as the recursion: d_k varies with e_k, by what h^p of the motion's rates is
// beside 1, and where the spectral radius is closer to 1 than that, the bound says nothing. (The crank-rocker blows up
// at h sqrt(beta) = 2.65 to 2.75, where R alone would allow 2.785.)
#pragma once

#include <Eigen/LU>
#include <boost/multiprecision/eigen.hpp>
#include <optional>
#include <slideway/oracle/method.hpp>
#include <slideway/oracle/trajectory.hpp>

namespace slideway::oracle {

template <class T>
using Map = Eigen::Matrix<T, 2, 2>;

/// sum over k <= order of (hA)^k / k!: the explicit Runge-Kutta methods of order 1 to 4 with as many stages.
template <class T>
Map<T> runge_kutta_map(int order, const T& h, const T& alpha, const T& beta) {
  Map<T> A, term = Map<T>::Identity(), sum = term;
  A << T(0), T(1), T(-beta), T(-alpha);
  for (int k = 1; k <= order; ++k) {
    term = (term * A * T(h / k)).eval();
    sum += term;
  }
  return sum;
}

/// Of an explicit Runge-Kutta method: I + h sum b_k K_k with K_k = A (I + h sum a_kj K_j). Its stability polynomial of
/// hA, whatever the order.
template <class T>
Map<T> runge_kutta_map(const RungeKutta<T>& method, const T& h, const T& alpha, const T& beta) {
  Map<T> A, R = Map<T>::Identity();
  A << T(0), T(1), T(-beta), T(-alpha);
  std::vector<Map<T>> K;
  for (std::size_t k = 0; k < method.b.size(); ++k) {
    Map<T> stage = Map<T>::Identity();
    for (std::size_t j = 0; j < k; ++j) stage += K[j] * T(h * method.a[k][j]);
    K.push_back(A * stage);
    R += K[k] * T(h * method.b[k]);
  }
  return R;
}

/// The kernel's euler: Phi' += h Phi'', then Phi += h Phi'. Stable for h^2 beta + 2 h alpha < 4 (Jury's conditions,
/// with the determinant 1 - h alpha and the trace 2 - h alpha - h^2 beta).
template <class T>
Map<T> semi_implicit_map(const T& h, const T& alpha, const T& beta) {
  Map<T> R;
  R << T(1 - h * h * beta), T(h - h * h * alpha), T(-h * beta), T(1 - h * alpha);
  return R;
}

template <class T>
Map<T> drift_map(Scheme scheme, const T& h, const T& alpha, const T& beta) {
  return scheme == Scheme::euler ? semi_implicit_map(h, alpha, beta)
                                 : runge_kutta_map(runge_kutta<T>(scheme), h, alpha, beta);
}

/// Largest |eigenvalue|.
template <class T>
T spectral_radius(const Map<T>& R) {
  using std::abs, std::sqrt;
  const T half_trace = (R(0, 0) + R(1, 1)) / 2, determinant = R(0, 0) * R(1, 1) - R(0, 1) * R(1, 0);
  const T square = half_trace * half_trace - determinant;
  return square < 0 ? T(sqrt(determinant)) : T(abs(half_trace) + sqrt(square));
}

/// The h up to which map_at(h) has a spectral radius below 1: the first crossing, to rounding, unless the radius
/// exceeds 1 only within 1 % of h. 0 if there is none between `from`, a step that is small beside the gains' times, and
/// 1e4 of it, or `from` itself is unstable.
template <class T, class MapAt>
T largest_stable_step(const MapAt& map_at, const T& from) {
  const auto stable = [&](const T& h) { return spectral_radius<T>(map_at(h)) < 1; };
  T low = from, high = from;
  for (; stable(high); high *= T(101) / 100) {
    if (high > 10000 * from) return T(0);
    low = high;
  }
  if (high == from) return T(0);
  for (int halving = 0; halving < std::numeric_limits<T>::digits; ++halving) {
    const T middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

/// Of the first `steps` powers of R, entry by entry: the sum of magnitudes and the largest magnitude, or bounds on both
/// for all powers once they have become small. With M = |R^m|, |R^(bm+j)| <= M^b |R^j|, so sums over all powers are at
/// most (I - M)^-1 times those over the first m.
template <class T>
struct Propagation {
  Map<T> sum, peak;
};

template <class T>
Propagation<T> propagation(const Map<T>& R, long steps) {
  const Map<T> one = Map<T>::Identity();
  Propagation<T> p{Map<T>::Zero(), one};
  Map<T> power = one;
  for (long k = 0; k < steps; ++k) {
    p.sum += power.cwiseAbs();
    power = (power * R).eval();
    const Map<T> M = power.cwiseAbs();
    p.peak = p.peak.cwiseMax(M).eval();
    if (!(spectral_radius(M) < T(0x1p-20))) continue;
    const Map<T> later = (one - M).inverse();
    return {Map<T>(later * p.sum), Map<T>(later * p.peak)};
  }
  return p;
}

/// P of the norm in which R contracts by rho, above its spectral radius; Q = diag(1, 1 / beta), which measures Phi' in
/// units of Phi times sqrt(beta). Three linear equations.
template <class T>
Map<T> lyapunov_matrix(const Map<T>& R, const T& rho, const T& beta) {
  const T a = R(0, 0) / rho, b = R(0, 1) / rho, c = R(1, 0) / rho, d = R(1, 1) / rho;
  Eigen::Matrix<T, 3, 3> equations;
  equations << T(1 - a * a), T(-2 * a * c), T(-c * c),  //
      T(-a * b), T(1 - a * d - b * c), T(-c * d),       //
      T(-b * b), T(-2 * b * d), T(1 - d * d);
  const Eigen::Matrix<T, 3, 1> Q(T(1), T(0), T(1 / beta));
  const Eigen::Matrix<T, 3, 1> p = equations.partialPivLu().solve(Q);
  Map<T> P;
  P << p(0), p(1), p(1), p(2);
  return P;
}

/// |e_k|_P <= rho^k |e_0|_P + d_P / (1 - rho), and what follows for |Phi| and |Phi'|, in any number of steps.
template <class T>
struct NormBound {
  T rho;
  Drift<T> bound;
};

/// By |(x, y)|_P <= sqrt(P_11) |x| + sqrt(P_22) |y| and |x|^2 <= (P^-1)_11 |(x, y)|_P^2. Of 15 rho between the spectral
/// radius and 1 the one that bounds |Phi| best. R is stable.
template <class T>
NormBound<T> norm_bound(const Map<T>& R, const T& beta, const Drift<T>& start, const Drift<T>& defect) {
  using std::sqrt;
  constexpr int parts = 16;
  const T radius = spectral_radius(R);
  NormBound<T> best{T(1), {}};
  for (int i = 1; i < parts; ++i) {
    const T rho = radius + (1 - radius) * T(i) / parts;
    const Map<T> P = lyapunov_matrix(R, rho, beta), inverse = P.inverse();
    const auto size = [&](const Drift<T>& e) { return T(sqrt(P(0, 0)) * e.position + sqrt(P(1, 1)) * e.velocity); };
    const T most = size(start) + size(defect) / (1 - rho);
    const Drift<T> bound{T(sqrt(inverse(0, 0)) * most), T(sqrt(inverse(1, 1)) * most)};
    if (i == 1 || bound.position < best.bound.position) best = {rho, bound};
  }
  return best;
}

/// Factor on the largest sampled defect. Between samples a defect exceeds both neighbours by (spacing / time in which
/// it changes)^2 / 8 of itself at most, a part that is small with samples enough; another part is how it varies with
/// the drift itself. 2 leaves as much for both together as was measured.
inline constexpr int defect_margin = 2;

/// Times to sample the motion at: `count` over the duration, and starts of steps of h that cross an event, which have
/// larger defects: a quarter and three quarters of h before it, on either side of the middle stages. Ascending.
template <class T>
std::vector<T> sample_times(const std::vector<TrajectoryEvent<T>>& events, const T& h, const T& duration, int count) {
  std::vector<T> times;
  for (int i = 0; i < count; ++i) times.push_back(duration * T(i) / T(count));
  for (const auto& event : events) {
    for (int part = 1; part < 4; part += 2) {
      const T t = event.t - h * T(part) / 4;
      if (t >= 0 && t <= duration) times.push_back(t);
    }
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// What a step in doubles adds. `defect`: its own roundings; `noise`: those of measuring the drift where it is.
template <class T>
struct Rounding {
  Drift<T> defect, noise;
};

/// Roundings of one step from -> to of h: a model, of worst cases that add up. With u = 2^-53 and a lever l_j of 2
/// reach for a turning coordinate and 1 for a sliding one:
///   q_j is rounded by u |q_j|, which moves points by l_j as much, v_j by u |v_j|;
///   places and velocities of points, from which Phi, Phi' and the accelerations come, are rounded 8 times a body (a
///   rotation's six and a sum), and gains and h take their part of that into Phi';
///   so are accelerations, and `loads`, those that forces give one by one and that may cancel.
template <class T>
Rounding<T> rounding(Method<T>& method, const TreeState<T>& from, const T& h, const TreeState<T>& to, const T& loads);

/// What the kernel's projection leaves at any of the states, with the noise of measuring it. It stops where every |Phi|
/// is below 16 eps (bodies + 1) times the largest distance; rates are then solved for, with as many roundings of the
/// largest speed.
template <class T>
Drift<T> projected_drift(Method<T>& method, const std::vector<TreeState<T>>& states);

/// And what that is in q and v: all constraints missed by it, with two patterns of signs, times the root of their
/// number for the patterns that are not tried; v is solved for at a q that is off, which doubles it.
template <class T>
Drift<T> projection_error(Method<T>& method, const std::vector<TreeState<T>>& states);

/// Largest defect of a step from any of the states, over all constraints, a pin's two rows as one vector: |e_1 - R e_0|
/// with margin, and the largest rounding. Nothing if the law has no step from one of the states.
template <class T>
std::optional<Rounding<T>> largest_defect(Method<T>& method, Scheme scheme, const T& h,
                                          const std::vector<TreeState<T>>& states);

/// What |Phi| and |Phi'| of all constraints cannot exceed.
template <class T>
struct DriftBound {
  T radius;                             ///< spectral radius of R
  bool stable;                          ///< radius < 1: the bound is one for any number of steps
  Drift<T> defect;                      ///< of one step, rounding included
  Drift<T> bound;                       ///< by (1), over the steps asked for, as the kernel measures it
  std::optional<NormBound<T>> in_norm;  ///< if stable; without the noise of measuring
};

/// For a run of `steps` steps of h from `start`, on the constraints or not; `states` sample the motion. Nothing as for
/// largest_defect. Gains are the method's model's.
template <class T>
std::optional<DriftBound<T>> drift_bound(Method<T>& method, Scheme scheme, const T& h, long steps,
                                         const TreeState<T>& start, const std::vector<TreeState<T>>& states);

}  // namespace slideway::oracle
