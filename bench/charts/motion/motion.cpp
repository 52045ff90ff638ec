#include "motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slideway::charts {

CartesianMotion::CartesianMotion(const RunScene& scene)
    : scene_(scene), equations_(scene), contacts_(contacts(scene)), forces_(contacts_) {
  n = 3 * scene.bodies;
  for (signed char& s : sign_) s = 1;
  forces_ += 2 * scene.pins + scene.drives + scene.guides;
  for (int i = 0; i < scene.bodies; ++i) forces_ += 3 - coordinates(scene.body[i].joint);
}

bool CartesianMotion::begin(const double* q, const double* v, double* y) {
  equations_.from_joints(q, v, y, y + n);
  return true;
}

bool CartesianMotion::rates(double t, const double* y, double* dy) {
  ++evaluations_;
  GuideFriction friction[Size::guides];
  const bool follow = frictions(y, friction);
  std::copy(y + n, y + 2 * n, dy);
  return equations_.accelerate(t, y, y + n, friction, sign_, follow, dy + n);
}

bool CartesianMotion::look(double t, const double* y, double* q, double* lambda) {
  double v[Size::coordinates], dy[6 * Size::bodies];
  equations_.to_joints(y, y + n, q, v);
  if (!rates(t, y, dy)) return false;
  for (int c = 0; c < contacts_; ++c) lambda[c] = equations_.lambda(c);
  return true;
}

void CartesianMotion::copy_forces(double* force) const {
  std::fill(std::copy_n(equations_.forces(), equations_.rows(), force), force + forces_, 0.0);
}

void CartesianMotion::residual(double t, const double* y, const double* acceleration, const double* force,
                               double* left) {
  ++evaluations_;
  GuideFriction friction[Size::guides];
  if (!frictions(y, friction)) {
    const double* lambda = force + (forces_ - scene_.guides - contacts_);
    for (int c = 0; c < contacts_; ++c) sign_[c] = lambda[c] < 0 ? -1 : 1;
  }
  equations_.residual(t, y, y + n, friction, sign_, acceleration, force, left);
  for (int row = equations_.rows(); row < forces_; ++row) left[n + row] = force[row];
}

namespace {

class CartesianRegularised final : public CartesianMotion {
 public:
  CartesianRegularised(const RunScene& scene, double width) : CartesianMotion(scene), width_(width) {}

 private:
  bool frictions(const double* y, GuideFriction* friction) override {
    for (int g = 0; g < scene_.guides; ++g) {
      friction[g].per_force = -scene_.guide[g].mu * std::tanh(equations_.slip(g, y, y + n) / width_);
    }
    return false;
  }

  double width_;
};

/// Which mode comes next is decided as LentModal does.
class CartesianModal final : public CartesianMotion {
 public:
  explicit CartesianModal(const RunScene& scene) : CartesianMotion(scene), modal_(scene) {}
  bool begin(const double* q, const double* v, double* y) override {
    double speed[Size::coordinates];
    std::copy_n(v, modal_.coordinates(), speed);
    return modal_.begin(0, q, speed) && CartesianMotion::begin(q, speed, y);
  }
  int functions() const override { return modal_.functions(); }
  bool values(double t, const double* y, double* value) override {
    double dy[6 * Size::bodies];
    if (!rates(t, y, dy)) return false;
    values_of(y, equations_.forces(), value);
    return true;
  }
  void values_of(const double* y, const double* force, double* value) const override {
    const Modes<Size>& m = modal_.modes();
    for (int k = 0; k < functions(); ++k) {
      const int i = modal_.watched(k), g = i - Size::contacts;
      if (i < Size::contacts) {
        value[k] = m.sign[i] * force[equations_.row_of_contact(i)];
      } else if (m.mode[g] != 0) {
        value[k] = m.mode[g] * equations_.slip(g, y, y + n);
      } else {
        value[k] = limit_left(g, force);
      }
    }
  }
  bool pass(double t, double* y, const int* zero) override {
    double q[Size::coordinates], v[Size::coordinates];
    equations_.to_joints(y, y + n, q, v);
    return modal_.pass(t, q, v, zero) && CartesianMotion::begin(q, v, y);
  }

 private:
  bool frictions(const double*, GuideFriction* friction) override {
    const Modes<Size>& m = modal_.modes();
    for (int g = 0; g < scene_.guides; ++g) {
      friction[g] = {-m.mode[g] * scene_.guide[g].mu, m.mode[g] == 0 && scene_.guide[g].mu_static > 0};
    }
    std::copy_n(m.sign, contacts_, sign_);
    return true;
  }
  double limit_left(int g, const double* force) const {
    const Guide& guide = scene_.guide[g];
    int c = 0;
    for (int o = 0; o < g; ++o) c += scene_.guide[o].contacts;
    double limit = guide.preload;
    for (int k = 0; k < guide.contacts; ++k) {
      limit += guide.mu_static * modal_.modes().sign[c + k] * force[equations_.row_of_contact(c + k)];
    }
    return limit - std::fabs(force[equations_.row_of_held(g)]);
  }

  ModalEquations modal_;
};

class LentRegularised final : public Motion {
 public:
  LentRegularised(const RunScene& scene, double width) : equations_(scene, width) { n = equations_.coordinates(); }
  bool begin(const double* q, const double* v, double* y) override {
    std::copy_n(q, n, y);
    std::copy_n(v, n, y + n);
    return true;
  }
  bool rates(double t, const double* y, double* dy) override {
    std::copy(y + n, y + 2 * n, dy);
    return equations_.accelerate(t, y, y + n, dy + n);
  }
  bool look(double t, const double* y, double* q, double* lambda) override {
    double acceleration[Size::coordinates];
    std::copy_n(y, n, q);
    return equations_.accelerate(t, y, y + n, acceleration, lambda);
  }
  long evaluations() const override { return equations_.evaluations(); }

 private:
  RegularisedEquations equations_;
};

class LentModal final : public Motion {
 public:
  explicit LentModal(const RunScene& scene) : equations_(scene) { n = equations_.coordinates(); }
  bool begin(const double* q, const double* v, double* y) override {
    std::copy_n(q, n, y);
    std::copy_n(v, n, y + n);
    return equations_.begin(0, y, y + n);
  }
  bool rates(double t, const double* y, double* dy) override {
    std::copy(y + n, y + 2 * n, dy);
    return equations_.accelerate(t, y, y + n, dy + n);
  }
  int functions() const override { return equations_.functions(); }
  bool values(double t, const double* y, double* value) override { return equations_.values(t, y, y + n, value); }
  bool pass(double t, double* y, const int* zero) override { return equations_.pass(t, y, y + n, zero); }
  bool look(double t, const double* y, double* q, double* lambda) override {
    std::copy_n(y, n, q);
    return equations_.forces(t, y, y + n, lambda);
  }
  long evaluations() const override { return equations_.evaluations(); }

 private:
  ModalEquations equations_;
};

}  // namespace

std::unique_ptr<CartesianMotion> cartesian_motion(const RunScene& scene, double width) {
  if (width == 0) return std::make_unique<CartesianModal>(scene);
  return std::make_unique<CartesianRegularised>(scene, width);
}

std::unique_ptr<Motion> lent_motion(const RunScene& scene, double width) {
  if (width == 0) return std::make_unique<LentModal>(scene);
  return std::make_unique<LentRegularised>(scene, width);
}

Outcome run_through(const RunScene& scene, const std::vector<double>& times, Motion& motion,
                    const MakeIntegrator& make) {
  constexpr int most_events = 10000;
  const io::RunStepper stepper(scene);
  const auto start = stepper.start();
  std::vector<double> y(2 * static_cast<std::size_t>(motion.n));
  Outcome outcome;
  const auto fail = [&](const char* why) {
    outcome.failure = why;
    outcome.evaluations = motion.evaluations();
    return outcome;
  };
  if (!motion.begin(start.q, start.v, y.data())) return fail("no start");
  const auto integrator = make(y);
  double t = 0;
  std::vector<int> zero;
  int events = 0;
  for (const double end : times) {
    while (t < end) {
      bool event = false;
      if (!integrator->advance(end, t, zero, event)) return fail("the integrator gave up");
      if (!event) continue;
      if (++events > most_events) return fail("event after event");
      if (!motion.pass(t, integrator->data(), zero.data())) return fail("no mode after an event");
      if (!integrator->restart(t)) return fail("no restart");
    }
    outcome.q.emplace_back(stepper.source.tables.coordinates);
    outcome.lambda.emplace_back(stepper.source.tables.contacts);
    if (!motion.look(t, integrator->data(), outcome.q.back().data(), outcome.lambda.back().data())) {
      return fail("no forces");
    }
  }
  outcome.evaluations = motion.evaluations();
  return outcome;
}

std::vector<double> friction_widths(const RunScene& scene) {
  for (int g = 0; g < scene.guides; ++g) {
    if (scene.guide[g].mu_static > 0) return {0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  }
  return {0};
}

std::string with_width(const std::string& solver, double width) {
  return width == 0 ? solver : fmt::format("{}, tanh(v / {:g} m/s)", solver, width);
}

std::vector<double> tolerances() {
  std::vector<double> all;
  for (int k = 4; k <= 26; ++k) all.push_back(std::pow(10, -k / 2.0));
  return all;
}

}  // namespace slideway::charts
