// Positions and velocities moved onto the constraints, by the least change in the mass metric.
#pragma once

#include <slideway/acceleration.hpp>

namespace slideway {

/// As many independent constraints as coordinates: the drives decide the whole motion.
template <class Source>
constexpr bool fully_driven(const Source& source) noexcept {
  return source.tables.free == source.tables.contacts + 2 * source.scene.pins;
}

/// Newton steps a projection may take: from a tenth of the scene's length four do, from far away none will.
inline constexpr int projection_limit = 16;

/// Newton's corrections of one q and v.
template <class Source>
class Projection {
  using Size = typename Source::Size;
  static constexpr int rows = at_least_one(2 * Size::pins + Size::contacts + Size::guides);

 public:
  /// q, v: moved in place. tau places live inputs.
  Projection(const Source& source, const Inputs<Size>& inputs, double tau, double* q, double* v) noexcept
      : source_(source), inputs_(inputs), tau_(tau), q_(q), v_(v) {}

  /// Moves q, v onto the constraints at time t: driven coordinates onto their laws, the free ones by the least change
  /// in the mass metric; guides for which `held` says so (none: null) to sliding speed zero.
  /// Without `rates`, q alone.
  /// ok, singular_constraints (redundant in this pose) or no_convergence.
  ///
  /// Done when every |Phi| is below 16 eps (bodies + 1) times the largest distance: the rounding of a point's place,
  /// a few eps for each body on its path. At most `projection_limit` Newton steps, each O(constraints^2 coordinates).
  Status onto_constraints(double t, const signed char* held, bool rates = true) noexcept {
    for (int i = 0; i < source_.scene.drives; ++i) {
      const LawValue law = law_at(source_.scene.drive[i], t, inputs_.input, tau_);
      const int j = source_.tables.first[source_.scene.drive[i].body] + source_.scene.drive[i].axis;
      q_[j] = law.value;
      if (rates) v_[j] = law.rate;
    }
    for (int step = 0; step <= projection_limit; ++step) {
      if (!metric()) return Status::singular_constraints;
      if (!take_constraints(1, 0)) return Status::singular_constraints;
      if (!(worst_ - worst_ == 0)) return Status::no_convergence;
      if (worst_ <= 16 * detail::epsilon * (source_.scene.bodies + 1) * reach_) {
        if (!rates) return Status::ok;
        take_constraints(0, 1);
        if (held != nullptr) take_guides(held);
        apply(v_);
        return Status::ok;
      }
      apply(q_);
    }
    return Status::no_convergence;
  }

  /// Brings the sliding speed of the guides whose mode is 0 in `held` to zero and leaves the rates of all constraints
  /// as they are, if that changes v by at most `most` of the length of `by`, in the mass metric. False, and nothing
  /// done, if not: near a dead centre the whole mechanism would have to stop for a guide that only turns back.
  bool arrest(const signed char* held, double most, const double* by) noexcept {
    if (!metric()) return false;
    take_constraints(0, 0);
    take_guides(held);
    double squared = 0;
    for (int f = 0; f < source_.tables.free; ++f) squared += basis_.change[f] * basis_.change[f];
    if (!(std::sqrt(squared) <= most * length(by))) return false;
    apply(v_);
    return true;
  }

 private:
  bool metric() noexcept {
    const double none_prescribed[at_least_one(Size::coordinates)] = {};
    kinematics(source_, q_, v_, none_prescribed, k_);
    apply_forces(source_, k_, inputs_, tau_, d_);
    gather(source_, k_, d_);
    return factor_mass(source_, k_, q_, v_, d_);
  }

  /// |G x| of a velocity x, by coordinate; the free ones.
  double length(const double* x) const noexcept {
    const auto& table = source_.tables;
    double sum = 0;
    for (int f = 0; f < table.free; ++f) {
      double u = d_.M[f][f] * x[table.free_coordinate[f]];
      for (int e = 0; e < table.ups[f]; ++e) {
        u += d_.M[f][table.up[f][e]] * x[table.free_coordinate[table.up[f][e]]];
      }
      sum += u * u;
    }
    return std::sqrt(sum);
  }

  bool take(const Link<Size>& link, Vec2 place, Vec2 direction, double right) noexcept {
    double* row = basis_.next();
    const int part = detail::part_of(source_.tables, link);
    each_in_part(source_, part, [&](int f) { row[f] = 0; });
    metric_row(source_, k_, d_, link, place, direction, row);
    return basis_.take(part, std::sqrt(inner(source_, part, row, row)), right);
  }

  /// All constraints, to be moved by -(positions Phi + rates Phi'). False when they are redundant.
  bool take_constraints(double positions, double rates) noexcept {
    const auto& scene = source_.scene;
    const auto& table = source_.tables;
    bool independent = true;
    basis_.forget(0);
    worst_ = 0;
    reach_ = table.length;
    const auto constrain = [&](const Link<Size>& link, Vec2 place, Vec2 direction, double Phi, double rate) {
      worst_ = worst_ >= std::fabs(Phi) || !(worst_ == worst_) ? worst_ : std::fabs(Phi);  // NaN stays
      reach_ = larger(reach_, larger(std::fabs(place.x), std::fabs(place.y)));
      independent = take(link, place, direction, -(positions * Phi + rates * rate)) && independent;
    };
    for (int p = 0; p < scene.pins; ++p) {
      Meeting at;
      meeting(source_, k_, p, at);
      constrain(table.pin[p], at.place, {1, 0}, at.Phi.x, at.rate.x);
      constrain(table.pin[p], at.place, {0, 1}, at.Phi.y, at.rate.y);
    }
    for (int g = 0; g < scene.guides; ++g) {
      Sliding s;
      sliding(source_, k_, g, s);
      for (int i = 0; i < scene.guide[g].contacts; ++i) {
        const Vec2 place = i == 0 ? s.place : s.place + s.along * s.t + s.across * s.n;
        constrain(table.guide[g], place, s.n, s.Phi[i], s.Phi_rate[i]);
      }
    }
    return independent;
  }

  /// Guides at rest; one whose speed follows from the others' is left to them.
  void take_guides(const signed char* held) noexcept {
    for (int g = 0; g < source_.scene.guides; ++g) {
      if (!source_.tables.is_rough[g] || held[g] != 0) continue;
      Sliding s;
      sliding(source_, k_, g, s);
      take(source_.tables.guide[g], s.place, s.t, -s.slip[0]);
    }
  }

  void apply(double* x) noexcept {
    double change[at_least_one(Size::coordinates)];
    for (int f = 0; f < source_.tables.free; ++f) change[f] = basis_.change[f];
    from_metric(source_, d_, change);
    for (int f = 0; f < source_.tables.free; ++f) x[source_.tables.free_coordinate[f]] += change[f];
  }

  const Source& source_;
  const Inputs<Size>& inputs_;
  double tau_, *q_, *v_;
  double worst_ = 0, reach_ = 0;
  Kinematics<Size> k_;
  Dynamics<Size> d_;
  Basis<Source, rows> basis_{source_};
};

}  // namespace slideway
