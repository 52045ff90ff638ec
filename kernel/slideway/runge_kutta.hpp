// The stages of a Runge-Kutta method between two times.
#pragma once

#include <slideway/project.hpp>
#include <slideway/tableau.hpp>

namespace slideway {

template <class Size>
struct Phase {
  double q[at_least_one(Size::coordinates)], v[at_least_one(Size::coordinates)];
};

/// rad; it changes a guide's direction by an eighth: 1 - cos(1/2) = 0.12.
inline constexpr double far_turn = 0.5;

/// Does friction meet a coordinate that turns by more than `far_turn` between two poses? Contact forces may then have
/// gone through infinity and come back, and there may have been none, or several, in between.
template <class Source>
SLIDEWAY_INLINE bool turns_far(const Source& source, const double* from, const double* to) noexcept {
  const auto& table = source.tables;
  double most = 0;
  for_each<Source, Source::Size::coordinates>(table.coordinates, [&](int j) SLIDEWAY_FOLD {
    if (table.motion[j] == Motion::turn) most = larger(most, std::fabs(to[j] - from[j]));
  });
  return table.rough > 0 && most > far_turn;
}

/// What all evaluations of one step have in common.
template <class Source>
struct Setting {
  using Size = typename Source::Size;
  const Source& source;
  const Solving& solving;
  const Inputs<Size>& inputs;
  double t;  ///< of the step's start, s
  Report& report;

  /// accelerate() at `tau` after the step's start.
  SLIDEWAY_INLINE Status evaluate(double tau, const Phase<Size>& at, Aim aim, bool at_start, Modes<Size>& m,
                                  Reaction<Size>& r) const noexcept {
    return accelerate(source, Moment<Size>{t + tau, tau, at.q, at.v, inputs, aim, at_start}, solving, m, r, report);
  }
};

constexpr void add(EnergyFlow& sum, double weight, const EnergyFlow& power) noexcept {
  sum.work += weight * power.work;
  sum.dissipated += weight * power.dissipated;
  sum.constraint_work += weight * power.constraint_work;
}

/// A method's step of h from `from` at `tau` after the setting's time, of which the first stage's reaction is known:
/// the phase where it ends, and the energies that crossed the border, by the method's own weights.
template <const auto& tableau, class Source>
class Stages {
  using Size = typename Source::Size;
  static constexpr int count = std::remove_reference_t<decltype(tableau)>::stages;

 public:
  Phase<Size> to;
  EnergyFlow flow;

  /// before(k) and after(k, r) surround the evaluation of each stage but the first. At the first refusal it ends.
  template <class Before, class After>
  Status run(const Setting<Source>& setting, double tau, double h, const Phase<Size>& from, const Reaction<Size>& first,
             Aim aim, Modes<Size>& m, Before&& before, After&& after) noexcept {
    return run(setting, tau, h, from, first, aim, m, before, after, std::make_integer_sequence<int, count>{});
  }

  /// Is a step long beside the motion's own times? The doubts are a doubtful part of sum |b_k a_k|, over all
  /// coordinates, an angle counting as the scene's length times it; and move something by 2^-40 of that length: at rest
  /// accelerations are rounding.
  bool is_too_long(const Source& source, double h) const noexcept {
    double apart = 0, size = 0;
    for (int j = 0; j < source.tables.coordinates; ++j) {
      double doubt[2] = {0, 0}, terms = 0;
      for (int k = 0; k < count; ++k) {
        doubt[0] += tableau.doubt[0][k] * a_[k][j];
        doubt[1] += tableau.doubt[1][k] * a_[k][j];
        terms += std::fabs(tableau.b[k] * a_[k][j]);
      }
      const double lever = source.tables.motion[j] == Motion::turn ? source.tables.length : 1;
      size += lever * terms;
      apart += lever * (std::fabs(doubt[0]) + std::fabs(doubt[1]));
    }
    return apart > tableau.doubtful * size && h * h * apart > 0x1p-40 * source.tables.length;
  }

 private:
  double a_[count][at_least_one(Size::coordinates)];

  template <int... K, class Before, class After>
  Status run(const Setting<Source>& setting, double tau, double h, const Phase<Size>& from, const Reaction<Size>& first,
             Aim aim, Modes<Size>& m, Before&& before, After&& after,
             std::integer_sequence<int, K...> stages) noexcept {
    const auto& source = setting.source;
    Reaction<Size> r;
    Status status = Status::ok;
    flow = {};
    add(flow, tableau.b[0] * h, first.power);
    keep(source, 0, first);
    const auto stage = [&](auto number) {
      constexpr int k = decltype(number)::value;
      if (k == 0 || status != Status::ok) return;
      combine<k>(source, h, from, to, stages);
      before(k);
      status = setting.evaluate(tau + tableau.c[k] * h, to, aim, false, m, r);
      if (status != Status::ok) return;
      after(k, r);
      add(flow, tableau.b[k] * h, r.power);
      keep(source, k, r);
    };
    (stage(std::integral_constant<int, K>{}), ...);
    if (status == Status::ok) combine<count>(source, h, from, to, stages);
    return status;
  }

  void keep(const Source& source, int k, const Reaction<Size>& r) noexcept {
    for_each<Source, Size::coordinates>(source.tables.coordinates,
                                        [&](int j) SLIDEWAY_FOLD { a_[k][j] = r.acceleration[j]; });
  }

  /// sum of c_i a_i over what a method has: its zeros cost nothing.
  template <int... I>
  SLIDEWAY_INLINE double sum(const double (&c)[count], int j, std::integer_sequence<int, I...>) const noexcept {
    double value = 0;
    ((c[I] != 0 ? void(value += c[I] * a_[I][j]) : void()), ...);
    return value;
  }

  /// Where stage k is, or for k = count where the step ends.
  template <int k, class Sequence>
  void combine(const Source& source, double h, const Phase<Size>& from, Phase<Size>& at, Sequence all) const noexcept {
    constexpr bool last = k == count;
    constexpr int row = k % count;
    constexpr const auto& of_v = last ? tableau.b : tableau.a[row];
    constexpr const auto& of_q = last ? tableau.ba : tableau.aa[row];
    constexpr double c = last ? 1 : tableau.c[row];
    for_each<Source, Size::coordinates>(source.tables.coordinates, [&](int j) SLIDEWAY_FOLD {
      at.v[j] = from.v[j] + h * sum(of_v, j, all);
      at.q[j] = from.q[j] + h * (c * from.v[j] + h * sum(of_q, j, all));
    });
  }
};

}  // namespace slideway
