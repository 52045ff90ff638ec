// Rheonomic constraints: what the drives prescribe.
#pragma once

#include <slideway/kinematics.hpp>

namespace slideway {

/// A law's value with its first and second derivative in time.
struct LawValue {
  double value, rate, acceleration;
};

/// An input's value tau after the start of the step that it was given with.
constexpr LawValue value_at(const Input& input, double tau) noexcept {
  return {input.value + (input.rate + 0.5 * input.acceleration * tau) * tau, input.rate + input.acceleration * tau,
          input.acceleration};
}

/// f, f', f'' of a drive's law at t; tau = t - (start of the step) places a live input. At most 8 terms.
SLIDEWAY_INLINE LawValue law_at(const Drive& drive, double t, const Input* input, double tau) noexcept {
  if (drive.law == Law::input) return value_at(input[drive.input], tau);
  const double* c = drive.c;
  if (drive.law == Law::uniform) return {c[0] + c[1] * t, c[1], 0};
  if (drive.law == Law::harmonic) {
    const Rotation phase = rotation(c[2] * t + c[3]);
    const double swing = c[1] * phase.s;
    return {c[0] + swing, c[1] * c[2] * phase.c, -(c[2] * c[2]) * swing};
  }
  double value = 0, rate = 0, half_acceleration = 0;  // Horner for the polynomial and its derivatives
  for (int k = drive.terms - 1; k >= 0; --k) {
    half_acceleration = half_acceleration * t + rate;
    rate = rate * t + value;
    value = value * t + c[k];
  }
  return {value, rate, 2 * half_acceleration};
}

/// The gains of Phi'' + alpha Phi' + beta Phi = 0 (WWZ14 (11), (12)), 1/s and 1/s^2.
struct Gains {
  double alpha = 20, beta = 100;
  double known = 1;  ///< factor on what Phi'' is without the free q''; 0 where rates are prescribed instead: step.hpp
};

/// What every driven coordinate is to do: prescribed[j] = f'' - alpha (q' - f') - beta (q - f), so that
/// phi'' + alpha phi' + beta phi = 0 for phi = q - f(t). Returns the largest |phi| and |phi'|.
template <class Source, class Size = typename Source::Size>
SLIDEWAY_INLINE void prescribe(const Source& source, const double* q, const double* v, double t,
                               const Inputs<Size>& inputs, double tau, Gains gains, double* prescribed,
                               double& drift_position, double& drift_velocity) noexcept {
  const auto& scene = source.scene;
  for_each<Source, Size::drives>(scene.drives, [&](int d) SLIDEWAY_FOLD {
    const Drive& drive = scene.drive[d];
    const int j = source.tables.first[drive.body] + drive.axis;
    const LawValue law = law_at(drive, t, inputs.input, tau);
    const double phi = q[j] - law.value, phi_rate = v[j] - law.rate;
    prescribed[j] = law.acceleration - gains.alpha * phi_rate - gains.beta * phi;
    drift_position = larger(drift_position, std::fabs(phi));
    drift_velocity = larger(drift_velocity, std::fabs(phi_rate));
  });
}

}  // namespace slideway
