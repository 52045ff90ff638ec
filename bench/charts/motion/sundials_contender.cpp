#include "motion.hpp"

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
#include <sundials/sundials_context.hpp>

namespace slideway::charts {

const bool has_sundials = true;

namespace {

enum class Solver { adams, bdf, runge_kutta };

int rates(realtype t, N_Vector y, N_Vector dy, void* self) {
  // 1: to be tried again with a shorter step.
  return static_cast<Motion*>(self)->rates(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)) ? 0 : 1;
}
int values(realtype t, N_Vector y, realtype* value, void* self) {
  return static_cast<Motion*>(self)->values(t, N_VGetArrayPointer(y), value) ? 0 : -1;
}

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

/// CVODE or ERKStep.
class OdeIntegrator final : public Integrator {
 public:
  OdeIntegrator(Solver solver, Motion& motion, double tolerance, const std::vector<double>& y)
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
      good_ = ERKStepSetErrFile(memory_.get(), nullptr) == 0 &&
              ERKStepSStolerances(memory_.get(), tolerance, tolerance) == 0 && ERKStepSetOrder(memory_.get(), 8) == 0 &&
              ERKStepSetUserData(memory_.get(), &motion) == 0 && ERKStepSetMaxNumSteps(memory_.get(), most_steps) == 0;
    } else {
      memory_.reset(CVodeCreate(solver_ == Solver::adams ? CV_ADAMS : CV_BDF, context_));
      good_ = CVodeSetErrFile(memory_.get(), nullptr) == 0 && CVodeInit(memory_.get(), rates, 0, y_.get()) == 0 &&
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

  double* data() override { return N_VGetArrayPointer(y_.get()); }

  bool advance(double end, double& t, std::vector<int>& zero, bool& event) override {
    if (!good_) return false;
    const int flag = solver_ == Solver::runge_kutta ? ERKStepEvolve(memory_.get(), end, y_.get(), &t, ARK_NORMAL)
                                                    : CVode(memory_.get(), end, y_.get(), &t, CV_NORMAL);
    event = flag == CV_ROOT_RETURN;  // the same number in ARKODE
    if (!event) return flag >= 0;
    zero.assign(static_cast<std::size_t>(motion_.functions()), 0);
    return (solver_ == Solver::runge_kutta ? ERKStepGetRootInfo(memory_.get(), zero.data())
                                           : CVodeGetRootInfo(memory_.get(), zero.data())) == 0;
  }

  bool restart(double t) override {
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
    family = fmt::format("SUNDIALS, {}{}", choice.width == 0 ? "modes" : "tanh", choice.lent ? ", lent equations" : "");
    name = with_width(name_of(choice.solver), choice.width);
    setting = "tolerance";
    settings = tolerances();
  }

  Outcome run(const std::vector<double>& times, double tolerance) const override {
    const std::unique_ptr<Motion> motion =
        choice_.lent ? lent_motion(scene_, choice_.width) : cartesian_motion(scene_, choice_.width);
    return run_through(scene_, times, *motion, [&](const std::vector<double>& y) {
      return std::make_unique<OdeIntegrator>(choice_.solver, *motion, tolerance, y);
    });
  }

 private:
  const RunScene& scene_;
  Choice choice_;
};

}  // namespace

void add_sundials(const RunScene& scene, Contenders& contenders) {
  for (const double width : friction_widths(scene)) {
    for (const bool lent : {false, true}) {
      for (const Solver solver : {Solver::adams, Solver::bdf, Solver::runge_kutta}) {
        contenders.push_back(std::make_unique<Sundials>(scene, Choice{solver, width, lent}));
      }
    }
  }
  add_ida(scene, contenders);
}

}  // namespace slideway::charts

#endif
