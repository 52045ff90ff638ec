#include "contender.hpp"

#ifndef SLIDEWAY_SUNDIALS

namespace slideway::charts {
const bool has_sundials = false;
void add_sundials(const RunScene&, Contenders&) {}
}  // namespace slideway::charts

#else

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sundials/sundials_context.hpp>

#include "cartesian.hpp"

namespace slideway::charts {

const bool has_sundials = true;

namespace {

enum class Solver { adams, bdf, runge_kutta };

/// What is integrated: y = (positions, speeds), n each.
class Motion {
 public:
  virtual ~Motion() = default;
  /// y of the start, from joint coordinates.
  virtual bool begin(const double* q, const double* v, double* y) = 0;
  virtual bool rates(double t, const double* y, double* dy) = 0;
  virtual int functions() const { return 0; }
  virtual bool values(double, const double*, double*) { return true; }
  virtual bool pass(double, double*, const int*) { return true; }
  virtual bool look(double t, const double* y, double* q, double* lambda) = 0;
  virtual long evaluations() const = 0;
  int n = 0;
};

class Regularised final : public Motion {
 public:
  Regularised(const RunScene& scene, double width) : equations_(scene, width) { n = equations_.coordinates(); }
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

class Modal final : public Motion {
 public:
  explicit Modal(const RunScene& scene) : equations_(scene) { n = equations_.coordinates(); }
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

/// y = (x, y, angle body by body; their rates).
class Cartesian : public Motion {
 public:
  explicit Cartesian(const RunScene& scene) : scene_(scene), equations_(scene), contacts_(contacts(scene)) {
    n = 3 * scene.bodies;
    for (signed char& s : sign_) s = 1;
  }
  bool begin(const double* q, const double* v, double* y) override {
    equations_.from_joints(q, v, y, y + n);
    return true;
  }
  bool look(double t, const double* y, double* q, double* lambda) override {
    double v[Size::coordinates], dy[6 * Size::bodies];
    equations_.to_joints(y, y + n, q, v);
    if (!rates(t, y, dy)) return false;
    for (int c = 0; c < contacts_; ++c) lambda[c] = equations_.lambda(c);
    return true;
  }
  long evaluations() const override { return evaluations_; }

 protected:
  const RunScene& scene_;
  CartesianEquations equations_;
  int contacts_;
  signed char sign_[Size::contacts];
  long evaluations_ = 0;
};

class CartesianRegularised final : public Cartesian {
 public:
  CartesianRegularised(const RunScene& scene, double width) : Cartesian(scene), width_(width) {}
  bool rates(double t, const double* y, double* dy) override {
    ++evaluations_;
    GuideFriction friction[Size::guides];
    for (int g = 0; g < scene_.guides; ++g) {
      friction[g].per_force = -scene_.guide[g].mu * std::tanh(equations_.slip(g, y, y + n) / width_);
    }
    std::copy(y + n, y + 2 * n, dy);
    return equations_.accelerate(t, y, y + n, friction, sign_, false, dy + n);
  }

 private:
  double width_;
};

/// Which mode comes next is decided as Modal does.
class CartesianModal final : public Cartesian {
 public:
  explicit CartesianModal(const RunScene& scene) : Cartesian(scene), modal_(scene) {}
  bool begin(const double* q, const double* v, double* y) override {
    double speed[Size::coordinates];
    std::copy_n(v, modal_.coordinates(), speed);
    return modal_.begin(0, q, speed) && Cartesian::begin(q, speed, y);
  }
  bool rates(double t, const double* y, double* dy) override {
    std::copy(y + n, y + 2 * n, dy);
    return solve(t, y, dy + n);
  }
  int functions() const override { return modal_.functions(); }
  bool values(double t, const double* y, double* value) override {
    double acceleration[3 * Size::bodies];
    if (!solve(t, y, acceleration)) return false;
    const Modes<Size>& m = modal_.modes();
    for (int k = 0; k < functions(); ++k) {
      const int i = modal_.watched(k), g = i - Size::contacts;
      if (i < Size::contacts) {
        value[k] = m.sign[i] * equations_.lambda(i);
      } else if (m.mode[g] != 0) {
        value[k] = m.mode[g] * equations_.slip(g, y, y + n);
      } else {
        value[k] = limit_left(g);
      }
    }
    return true;
  }
  bool pass(double t, double* y, const int* zero) override {
    double q[Size::coordinates], v[Size::coordinates];
    equations_.to_joints(y, y + n, q, v);
    return modal_.pass(t, q, v, zero) && Cartesian::begin(q, v, y);
  }

 private:
  bool solve(double t, const double* y, double* acceleration) {
    ++evaluations_;
    const Modes<Size>& m = modal_.modes();
    GuideFriction friction[Size::guides];
    for (int g = 0; g < scene_.guides; ++g) {
      friction[g] = {-m.mode[g] * scene_.guide[g].mu, m.mode[g] == 0 && scene_.guide[g].mu_static > 0};
    }
    std::copy_n(m.sign, contacts_, sign_);
    return equations_.accelerate(t, y, y + n, friction, sign_, true, acceleration);
  }
  double limit_left(int g) const {
    const Guide& guide = scene_.guide[g];
    int c = 0;
    for (int o = 0; o < g; ++o) c += scene_.guide[o].contacts;
    double limit = guide.preload;
    for (int k = 0; k < guide.contacts; ++k) limit += guide.mu_static * sign_[c + k] * equations_.lambda(c + k);
    return limit - std::fabs(equations_.held_force(g));
  }

  ModalEquations modal_;
};

int rates(realtype t, N_Vector y, N_Vector dy, void* self) {
  // 1: to be tried again with a shorter step.
  return static_cast<Motion*>(self)->rates(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)) ? 0 : 1;
}
int values(realtype t, N_Vector y, realtype* value, void* self) {
  return static_cast<Motion*>(self)->values(t, N_VGetArrayPointer(y), value) ? 0 : -1;
}

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

/// One of the integrators over y, from t on; begun anew after every event.
class Integrator {
 public:
  Integrator(Solver solver, Motion& motion, double tolerance, const std::vector<double>& y)
      : solver_(solver),
        motion_(motion),
        tolerance_(tolerance),
        n_(static_cast<sunindextype>(y.size())),
        y_(N_VNew_Serial(n_, context_), N_VDestroy),
        memory_(
            nullptr,
            solver == Solver::runge_kutta ? [](void* m) { ERKStepFree(&m); } : [](void* m) { CVodeFree(&m); }) {
    std::copy(y.begin(), y.end(), data());
    if (solver_ == Solver::runge_kutta) {
      memory_.reset(ERKStepCreate(rates, 0, y_.get(), context_));
      good_ = ERKStepSStolerances(memory_.get(), tolerance, tolerance) == 0 && ERKStepSetOrder(memory_.get(), 8) == 0 &&
              ERKStepSetUserData(memory_.get(), &motion) == 0 && ERKStepSetMaxNumSteps(memory_.get(), most_steps) == 0;
    } else {
      memory_.reset(CVodeCreate(solver_ == Solver::adams ? CV_ADAMS : CV_BDF, context_));
      good_ = CVodeInit(memory_.get(), rates, 0, y_.get()) == 0 &&
              CVodeSStolerances(memory_.get(), tolerance, tolerance) == 0 &&
              CVodeSetUserData(memory_.get(), &motion) == 0 && CVodeSetMaxNumSteps(memory_.get(), most_steps) == 0;
      if (solver_ == Solver::adams) {  // not stiff: their documentation's choice is fixed-point iteration
        fixed_point_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_));
        good_ = good_ && CVodeSetNonlinearSolver(memory_.get(), fixed_point_.get()) == 0;
      } else {
        matrix_.reset(SUNDenseMatrix(n_, n_, context_));
        linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_));
        good_ = good_ && CVodeSetLinearSolver(memory_.get(), linear_.get(), matrix_.get()) == 0;
      }
    }
    watch();
  }

  double* data() { return N_VGetArrayPointer(y_.get()); }

  /// To `end`, or to where functions vanish (`zero` then says which). False when it gives up.
  bool advance(double end, double& t, std::vector<int>& zero, bool& event) {
    if (!good_) return false;
    const int flag = solver_ == Solver::runge_kutta ? ERKStepEvolve(memory_.get(), end, y_.get(), &t, ARK_NORMAL)
                                                    : CVode(memory_.get(), end, y_.get(), &t, CV_NORMAL);
    event = flag == CV_ROOT_RETURN;  // the same number in ARKODE
    if (!event) return flag >= 0;
    zero.assign(static_cast<std::size_t>(motion_.functions()), 0);
    return (solver_ == Solver::runge_kutta ? ERKStepGetRootInfo(memory_.get(), zero.data())
                                           : CVodeGetRootInfo(memory_.get(), zero.data())) == 0;
  }

  /// y has jumped to another mode.
  bool restart(double t) {
    good_ = (solver_ == Solver::runge_kutta ? ERKStepReInit(memory_.get(), rates, t, y_.get())
                                            : CVodeReInit(memory_.get(), t, y_.get())) == 0;
    watch();
    return good_;
  }

 private:
  static constexpr long most_steps = 2000000;

  void watch() {
    const int count = motion_.functions();
    std::vector<int> falling(static_cast<std::size_t>(count), -1);
    if (solver_ == Solver::runge_kutta) {
      good_ = good_ && ERKStepRootInit(memory_.get(), count, values) == 0;
      if (count > 0) good_ = good_ && ERKStepSetRootDirection(memory_.get(), falling.data()) == 0;
      if (count > 0) ERKStepSetNoInactiveRootWarn(memory_.get());
    } else {
      good_ = good_ && CVodeRootInit(memory_.get(), count, values) == 0;
      if (count > 0) good_ = good_ && CVodeSetRootDirection(memory_.get(), falling.data()) == 0;
      if (count > 0) CVodeSetNoInactiveRootWarn(memory_.get());
    }
  }

  Solver solver_;
  Motion& motion_;
  double tolerance_;
  sundials::Context context_;
  sunindextype n_;
  Owned<std::remove_pointer_t<N_Vector> > y_;
  Owned<std::remove_pointer_t<SUNMatrix> > matrix_{nullptr, SUNMatDestroy};
  Owned<std::remove_pointer_t<SUNLinearSolver> > linear_{nullptr, [](SUNLinearSolver s) { SUNLinSolFree(s); }};
  Owned<std::remove_pointer_t<SUNNonlinearSolver> > fixed_point_{nullptr,
                                                                 [](SUNNonlinearSolver s) { SUNNonlinSolFree(s); }};
  Owned<void> memory_;
  bool good_ = true;
};

constexpr const char* name_of(Solver solver) {
  return solver == Solver::adams ? "CVODE Adams" : solver == Solver::bdf ? "CVODE BDF" : "ARKODE explicit, order 8";
}

struct Choice {
  Solver solver;
  double width;  ///< of tanh, m/s; 0: modes with root finding
  bool lent;     ///< slideway's equations instead of a user's own
};

class Sundials final : public Contender {
 public:
  Sundials(const RunScene& scene, Choice choice) : scene_(scene), choice_(choice) {
    const bool modes = choice.width == 0;
    family = fmt::format("SUNDIALS, {}{}", modes ? "modes" : "tanh", choice.lent ? ", lent equations" : "");
    name = modes ? name_of(choice.solver) : fmt::format("{}, tanh(v / {:g} m/s)", name_of(choice.solver), choice.width);
    setting = "tolerance";
    for (int k = 4; k <= 26; ++k) settings.push_back(std::pow(10, -k / 2.0));
  }

  Outcome run(const std::vector<double>& times, double tolerance) const override {
    const auto motion = make_motion();
    const io::RunStepper stepper(scene_);
    const auto start = stepper.start();
    std::vector<double> y(2 * static_cast<std::size_t>(motion->n));
    Outcome outcome;
    const auto fail = [&](const char* why) {
      outcome.failure = why;
      outcome.evaluations = motion->evaluations();
      return outcome;
    };
    if (!motion->begin(start.q, start.v, y.data())) return fail("no start");
    Integrator integrator(choice_.solver, *motion, tolerance, y);
    double t = 0;
    std::vector<int> zero;
    int events = 0;
    const int coordinates = stepper.source.tables.coordinates, contacts = stepper.source.tables.contacts;
    for (const double end : times) {
      while (t < end) {
        bool event = false;
        if (!integrator.advance(end, t, zero, event)) return fail("the integrator gave up");
        if (!event) continue;
        if (++events > most_events) return fail("event after event");
        if (!motion->pass(t, integrator.data(), zero.data())) return fail("no mode after an event");
        if (!integrator.restart(t)) return fail("no restart");
      }
      outcome.q.emplace_back(coordinates);
      outcome.lambda.emplace_back(contacts);
      if (!motion->look(t, integrator.data(), outcome.q.back().data(), outcome.lambda.back().data())) {
        return fail("no forces");
      }
    }
    outcome.evaluations = motion->evaluations();
    return outcome;
  }

 private:
  static constexpr int most_events = 10000;

  std::unique_ptr<Motion> make_motion() const {
    if (choice_.width == 0) {
      if (choice_.lent) return std::make_unique<Modal>(scene_);
      return std::make_unique<CartesianModal>(scene_);
    }
    if (choice_.lent) return std::make_unique<Regularised>(scene_, choice_.width);
    return std::make_unique<CartesianRegularised>(scene_, choice_.width);
  }

  const RunScene& scene_;
  Choice choice_;
};

}  // namespace

void add_sundials(const RunScene& scene, Contenders& contenders) {
  bool rough = false;
  for (int g = 0; g < scene.guides; ++g) rough = rough || scene.guide[g].mu_static > 0;
  for (const bool lent : {false, true}) {
    for (const Solver solver : {Solver::adams, Solver::bdf, Solver::runge_kutta}) {
      contenders.push_back(std::make_unique<Sundials>(scene, Choice{solver, 0, lent}));
      for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
        if (rough) contenders.push_back(std::make_unique<Sundials>(scene, Choice{solver, width, lent}));
      }
    }
  }
}

}  // namespace slideway::charts

#endif
