// Any scene for CVODE and IDA: the oracle's Cartesian rows in doubles. CVODE takes the accelerations from the oracle's
// KKT solution; IDA takes the rows alone, keeps accelerations and forces as unknowns, and solves for them itself.
#pragma once

#include "modes.hpp"

namespace slideway::test {

/// For CVODE: y'' by the oracle's solution of the KKT system.
class CartesianOde final : public Modes<OdeMotion> {
 public:
  using Modes::Modes;

  void rates(double at, const double* now, double* rates) override {
    solve(at, now);
    for (std::size_t i = 0; i < size(); ++i) {
      rates[i] = now[size() + i];
      rates[size() + i] = dynamics_.unknown(static_cast<int>(i), 0);
    }
  }
  void margins(double at, const double* now, double* margin) override {
    solve(at, now);
    for (const auto& condition : conditions_) *margin++ = law_.value(condition, 0);
  }
};

/// For IDA, the differential-algebraic system of index 1:
///   q' = v,  v' = a,  M a = h + J' lambda + friction,  J a + turning + alpha (J v - law') + beta (Phi - law) = law''
/// with accelerations as unknowns of their own: IDA knows v' as a difference of speeds, whose rounding over a short
/// step would be noise in the forces.
class CartesianDae final : public Modes<DaeMotion> {
 public:
  CartesianDae(const oracle::Model<oracle::Real>& exact, const oracle::Model<double>& model) : Modes(exact, model) {
    const auto& mechanism = dynamics_.mechanism;
    for (const Row& row : mechanism.joint) rows_.push_back({&row, 0, 0, none});
    for (int d = 0; d < static_cast<int>(model.drive.size()); ++d) {
      rows_.push_back({&mechanism.driven(d), model.alpha, model.beta, d});
    }
    for (const Row& row : mechanism.pin) rows_.push_back({&row, model.alpha, model.beta, none});
    for (const Row& row : mechanism.normal) rows_.push_back({&row, model.alpha, model.beta, none});
    begin_forces();
  }

  int differential() const override { return static_cast<int>(2 * size()); }

  void change_mode(const std::vector<int>& failed) override {
    Modes::change_mode(failed);
    begin_forces();
  }

  void residual(double at, const double* now, const double* rate, double* r) override {
    begin(at, now);
    const std::size_t n = size();
    const double *acceleration = now + 2 * n, *force = now + 3 * n;
    double *momentum = r + 2 * n, *equation = r + 3 * n;
    for (std::size_t i = 0; i < n; ++i) {
      r[i] = rate[i] - now[n + i];
      r[n + i] = rate[n + i] - acceleration[i];
      momentum[i] = dynamics_.mechanism.mass(static_cast<int>(i)) * acceleration[i] - dynamics_.mechanism.force[i][0];
    }
    for (const Constraint& c : rows_) {
      add_force(*c.row, *force++, momentum);
      *equation++ = along(*c.row, acceleration) + c.row->turning[0] + miss(c, at);
    }
    for (int g = 0; g < dynamics_.guides(); ++g) {
      const Row& sliding = dynamics_.sliding(g);
      add_force(sliding, friction(g, now), momentum);
      if (is_held(g)) *equation++ = along(sliding, acceleration) + sliding.turning[0];
    }
  }

  void margins(double at, const double* now, double* margin) override {
    begin(at, now);
    for (const auto& [kind, index, side] : conditions_) {
      if (kind == oracle::Condition::face) *margin = side * lambda(index, now);
      if (kind == oracle::Condition::slip) *margin = side * dynamics_.sliding(index).speed[0];
      if (kind == oracle::Condition::hold) *margin = limit(index, now) - side * friction(index, now);
      ++margin;
    }
  }

 private:
  struct Constraint {
    const Row* row;
    double alpha, beta;
    int drive;
  };

  bool is_held(int g) const { return dynamics_.guide(g).rough() && mode_.slip[static_cast<std::size_t>(g)] == 0; }

  /// Room for the mode's accelerations and forces; the unit of each is the largest of them.
  void begin_forces() {
    std::size_t forces = rows_.size();
    held_.assign(static_cast<std::size_t>(dynamics_.guides()), 0);
    for (int g = 0; g < dynamics_.guides(); ++g) {
      if (is_held(g)) held_[static_cast<std::size_t>(g)] = forces++;
    }
    solve(t, y.data());
    const auto largest = [&](std::size_t first, std::size_t count) {
      double most = 0;
      for (std::size_t i = first; i < first + count; ++i) {
        most = std::max(most, std::abs(dynamics_.unknown(static_cast<int>(i), 0)));
      }
      return most;
    };
    y.resize(3 * size() + forces, 0);
    unit.resize(2 * size());
    unit.resize(3 * size(), std::max(unit.back(), largest(0, size())));  // at least the unit of speed in a second
    unit.resize(3 * size() + forces, largest(size(), forces));
  }

  double lambda(int contact, const double* now) const {
    return now[3 * size() + rows_.size() - static_cast<std::size_t>(dynamics_.contacts() - contact)];
  }
  double limit(int g, const double* now) const {
    double sum = 0;
    for (int c = 0; c < dynamics_.contacts(); ++c) {
      const auto k = static_cast<std::size_t>(c);
      if (dynamics_.mechanism.guide_of[k] == g) sum += mode_.sign[k] * lambda(c, now);
    }
    return mu_[static_cast<std::size_t>(g)] * sum;
  }
  double friction(int g, const double* now) const {
    if (is_held(g)) return now[3 * size() + held_[static_cast<std::size_t>(g)]];
    return -mode_.slip[static_cast<std::size_t>(g)] * limit(g, now);
  }

  /// f along a row, taken from the momentum balance m.
  static void add_force(const Row& row, double f, double* m) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (row.a != ground) m[3 * row.a + static_cast<int>(j)] -= row.on_a[j][0] * f;
      if (row.b != ground) m[3 * row.b + static_cast<int>(j)] -= row.on_b[j][0] * f;
    }
  }
  static double along(const Row& row, const double* vector) {
    double sum = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      if (row.a != ground) sum += row.on_a[j][0] * vector[3 * row.a + static_cast<int>(j)];
      if (row.b != ground) sum += row.on_b[j][0] * vector[3 * row.b + static_cast<int>(j)];
    }
    return sum;
  }
  double miss(const Constraint& c, double at) const {
    double f[3] = {0, 0, 0};  // the drive's law and its rates
    if (c.drive != none) {
      const auto series = oracle::law_series(dynamics_.mechanism.model.drive[static_cast<std::size_t>(c.drive)], at, 3);
      f[0] = series[0];
      f[1] = series[1];
      f[2] = 2 * series[2];
    }
    return c.alpha * (c.row->speed[0] - f[1]) + c.beta * (c.row->value[0] - f[0]) - f[2];
  }

  std::vector<Constraint> rows_;
  std::vector<std::size_t> held_;  ///< place of a held guide's friction among the forces
};

}  // namespace slideway::test
