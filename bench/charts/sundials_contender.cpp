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

namespace slideway::charts {

const bool has_sundials = true;

namespace {

enum class Solver { adams, bdf, runge_kutta };

/// What is integrated: y = (q, v).
class Motion {
 public:
  virtual ~Motion() = default;
  virtual bool begin(double* y) = 0;
  virtual bool rates(double t, const double* y, double* dy) = 0;
  virtual int functions() const { return 0; }
  virtual bool values(double, const double*, double*) { return true; }
  virtual bool pass(double, double*, const int*) { return true; }
  virtual bool forces(double t, const double* y, double* lambda) = 0;
  virtual long evaluations() const = 0;
  int n = 0;  ///< coordinates
  int contacts = 0;
};

class Regularised final : public Motion {
 public:
  Regularised(const RunScene& scene, double width) : equations_(scene, width) {
    n = equations_.coordinates();
    contacts = equations_.contacts();
  }
  bool begin(double*) override { return true; }
  bool rates(double t, const double* y, double* dy) override {
    std::copy(y + n, y + 2 * n, dy);
    return equations_.accelerate(t, y, y + n, dy + n);
  }
  bool forces(double t, const double* y, double* lambda) override {
    double acceleration[Size::coordinates];
    return equations_.accelerate(t, y, y + n, acceleration, lambda);
  }
  long evaluations() const override { return equations_.evaluations(); }

 private:
  RegularisedEquations equations_;
};

class Modal final : public Motion {
 public:
  explicit Modal(const RunScene& scene) : equations_(scene) {
    n = equations_.coordinates();
    contacts = equations_.contacts();
  }
  bool begin(double* y) override { return equations_.begin(0, y, y + n); }
  bool rates(double t, const double* y, double* dy) override {
    std::copy(y + n, y + 2 * n, dy);
    return equations_.accelerate(t, y, y + n, dy + n);
  }
  int functions() const override { return equations_.functions(); }
  bool values(double t, const double* y, double* value) override { return equations_.values(t, y, y + n, value); }
  bool pass(double t, double* y, const int* zero) override { return equations_.pass(t, y, y + n, zero); }
  bool forces(double t, const double* y, double* lambda) override { return equations_.forces(t, y, y + n, lambda); }
  long evaluations() const override { return equations_.evaluations(); }

 private:
  ModalEquations equations_;
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
        memory_(nullptr, solver == Solver::runge_kutta ? [](void* m) { ERKStepFree(&m); }
                                                       : [](void* m) { CVodeFree(&m); }) {
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
  Owned<std::remove_pointer_t<N_Vector>> y_;
  Owned<std::remove_pointer_t<SUNMatrix>> matrix_{nullptr, SUNMatDestroy};
  Owned<std::remove_pointer_t<SUNLinearSolver>> linear_{nullptr, [](SUNLinearSolver s) { SUNLinSolFree(s); }};
  Owned<std::remove_pointer_t<SUNNonlinearSolver>> fixed_point_{nullptr,
                                                                [](SUNNonlinearSolver s) { SUNNonlinSolFree(s); }};
  Owned<void> memory_;
  bool good_ = true;
};

constexpr const char* name_of(Solver solver) {
  return solver == Solver::adams ? "CVODE Adams" : solver == Solver::bdf ? "CVODE BDF" : "ARKODE explicit, order 8";
}

class Sundials final : public Contender {
 public:
  /// width 0: modes with root finding.
  Sundials(const RunScene& scene, Solver solver, double width) : scene_(scene), solver_(solver), width_(width) {
    family = width > 0 ? "SUNDIALS, friction regularised" : "SUNDIALS, root finding on modes";
    name = width > 0 ? fmt::format("{}, tanh(v / {:g} m/s)", name_of(solver), width) : name_of(solver);
    setting = "tolerance";
    for (int k = 4; k <= 26; ++k) settings.push_back(std::pow(10, -k / 2.0));
  }

  Outcome run(const std::vector<double>& times, double tolerance) const override {
    std::unique_ptr<Motion> motion;
    if (width_ > 0) {
      motion = std::make_unique<Regularised>(scene_, width_);
    } else {
      motion = std::make_unique<Modal>(scene_);
    }
    const io::RunStepper stepper(scene_);
    const auto start = stepper.start();
    std::vector<double> y(start.q, start.q + motion->n);
    y.insert(y.end(), start.v, start.v + motion->n);
    Outcome outcome;
    const auto fail = [&](const char* why) {
      outcome.failure = why;
      outcome.evaluations = motion->evaluations();
      return outcome;
    };
    if (!motion->begin(y.data())) return fail("no start");
    Integrator integrator(solver_, *motion, tolerance, y);
    double t = 0;
    std::vector<int> zero;
    int events = 0;
    for (const double end : times) {
      while (t < end) {
        bool event = false;
        if (!integrator.advance(end, t, zero, event)) return fail("the integrator gave up");
        if (!event) continue;
        if (++events > most_events) return fail("event after event");
        if (!motion->pass(t, integrator.data(), zero.data())) return fail("no mode after an event");
        if (!integrator.restart(t)) return fail("no restart");
      }
      const double* now = integrator.data();
      outcome.q.emplace_back(now, now + motion->n);
      outcome.lambda.emplace_back(motion->contacts);
      if (!motion->forces(t, now, outcome.lambda.back().data())) return fail("no forces");
    }
    outcome.evaluations = motion->evaluations();
    return outcome;
  }

 private:
  static constexpr int most_events = 10000;
  const RunScene& scene_;
  Solver solver_;
  double width_;
};

}  // namespace

void add_sundials(const RunScene& scene, Contenders& contenders) {
  bool rough = false;
  for (int g = 0; g < scene.guides; ++g) rough = rough || scene.guide[g].mu_static > 0;
  for (const Solver solver : {Solver::adams, Solver::bdf, Solver::runge_kutta}) {
    contenders.push_back(std::make_unique<Sundials>(scene, solver, 0));
    for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      if (rough) contenders.push_back(std::make_unique<Sundials>(scene, solver, width));
    }
  }
}

}  // namespace slideway::charts

#endif
