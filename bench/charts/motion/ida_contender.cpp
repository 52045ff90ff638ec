// IDA on a user's Cartesian equations, where constraint forces are unknowns beside positions and speeds:
//
//     index 1    x' = u;   M u' + C f = Q;   Phi_q u' = gamma - alpha Phi' - beta Phi
//     index 2    x' = u + Phi_q^T m;   M u' + C f = Q;   Phi' = 0;   Phi = 0        (Gear, Gupta, Leimkuhler 1985)
//
// C is Phi_q^T with Coulomb's friction of each force. As IDA's documentation advises: SetId; CalcIC at each start where
// the index is 1, for which alone it is made; algebraic variables out of the error test where the index is 2.
#include "motion.hpp"

#ifndef SLIDEWAY_IDA

namespace slideway::charts {
void add_ida(const RunScene&, Contenders&) {}
}  // namespace slideway::charts

#else

#include <fmt/format.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <sundials/sundials_context.hpp>

namespace slideway::charts {
namespace {

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;
using Vector = Owned<std::remove_pointer_t<N_Vector> >;

/// y = (positions n, speeds n, forces k, and of index 2 multipliers m k).
class Ida final : public Integrator {
 public:
  Ida(CartesianMotion& motion, int index, double tolerance, const std::vector<double>& y)
      : motion_(motion), index_(index), n_(motion.n), k_(motion.forces()) {
    std::copy(y.begin(), y.end(), data());
    good_ = start_of(0) && IDASetErrFile(memory_.get(), nullptr) == 0 &&
            IDAInit(memory_.get(), residual, 0, y_.get(), rate_.get()) == 0 && set_tolerance(tolerance) &&
            IDASetUserData(memory_.get(), this) == 0 && IDASetMaxNumSteps(memory_.get(), most_steps) == 0 &&
            IDASetLinearSolver(memory_.get(), linear_.get(), matrix_.get()) == 0;
    N_VConst(0, id_.get());
    std::fill_n(N_VGetArrayPointer(id_.get()), 2 * n_, 1.0);
    good_ = good_ && IDASetId(memory_.get(), id_.get()) == 0 &&
            IDASetSuppressAlg(memory_.get(), index_ == 2 ? SUNTRUE : SUNFALSE) == 0;
    set_out(0);
  }

  double* data() override { return N_VGetArrayPointer(y_.get()); }

  bool advance(double end, double& t, std::vector<int>& zero, bool& event) override {
    if (!good_) return false;
    const int flag = IDASolve(memory_.get(), end, &t, y_.get(), rate_.get(), IDA_NORMAL);
    event = flag == IDA_ROOT_RETURN;
    if (!event) return flag >= 0;
    zero.assign(static_cast<std::size_t>(motion_.functions()), 0);
    return IDAGetRootInfo(memory_.get(), zero.data()) == 0;
  }

  bool restart(double t) override {
    good_ = start_of(t) && IDAReInit(memory_.get(), t, y_.get(), rate_.get()) == 0;
    set_out(t);
    return good_;
  }

 private:
  static constexpr long most_steps = 10000;  ///< between samples: a tenth of a second or two, longer than is charted

  /// Of index 2, forces and multipliers are known to order h less than positions, and roughly suffice: held to the same
  /// tolerance, Newton's iteration gives up from 1e-7 down.
  bool set_tolerance(double tolerance) {
    const Vector absolute(N_VClone(y_.get()), N_VDestroy);
    N_VConst(index_ == 2 ? 1 : tolerance, absolute.get());  // N
    std::fill_n(N_VGetArrayPointer(absolute.get()), 2 * n_, tolerance);
    return IDASVtolerances(memory_.get(), tolerance, absolute.get()) == 0;
  }

  /// Forces and accelerations that belong to positions and speeds.
  bool start_of(double t) {
    N_VConst(0, rate_.get());
    std::fill(data() + 2 * n_, data() + size_, 0.0);
    if (!motion_.rates(t, data(), N_VGetArrayPointer(rate_.get()))) return false;
    motion_.copy_forces(data() + 2 * n_);
    return true;
  }

  void set_out(double t) {
    const int count = motion_.functions();
    std::vector<int> falling(static_cast<std::size_t>(count), -1);
    good_ = good_ && IDARootInit(memory_.get(), count, values) == 0;
    if (count > 0) good_ = good_ && IDASetRootDirection(memory_.get(), falling.data()) == 0;
    if (count > 0) IDASetNoInactiveRootWarn(memory_.get());
    // The time beside t only says which way it goes on, and how fast.
    if (index_ == 1) good_ = good_ && IDACalcIC(memory_.get(), IDA_YA_YDP_INIT, t + 1e-3) == 0;
  }

  static int residual(realtype t, N_Vector y, N_Vector rate, N_Vector left, void* self) {
    static_cast<Ida*>(self)->residual(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate), N_VGetArrayPointer(left));
    return 0;
  }
  void residual(double t, const double* y, const double* rate, double* left) {
    const double *force = y + 2 * n_, *m = force + k_;
    motion_.residual(t, y, rate + n_, force, left + n_);
    for (int i = 0; i < n_; ++i) left[i] = y[n_ + i] - rate[i];
    if (index_ == 1) return;
    const CartesianEquations& equations = motion_.equations();
    equations.add_transposed(m, left);
    double *of_rate = left + 2 * n_, *of_position = of_rate + k_;
    std::copy_n(m, k_, of_position);
    for (int row = 0; row < equations.rows(); ++row) {
      of_rate[row] = equations.Phi_rate(row);
      of_position[row] = equations.Phi(row);
    }
  }

  static int values(realtype, N_Vector y, N_Vector, realtype* value, void* self) {
    const Ida& ida = *static_cast<Ida*>(self);
    ida.motion_.values_of(N_VGetArrayPointer(y), N_VGetArrayPointer(y) + 2 * ida.n_, value);
    return 0;
  }

  CartesianMotion& motion_;
  int index_, n_, k_;
  int size_ = 2 * n_ + index_ * k_;
  sundials::Context context_;
  Vector y_{N_VNew_Serial(size_, context_), N_VDestroy}, rate_{N_VClone(y_.get()), N_VDestroy},
      id_{N_VClone(y_.get()), N_VDestroy};
  Owned<std::remove_pointer_t<SUNMatrix> > matrix_{SUNDenseMatrix(size_, size_, context_), SUNMatDestroy};
  Owned<std::remove_pointer_t<SUNLinearSolver> > linear_{SUNLinSol_Dense(y_.get(), matrix_.get(), context_),
                                                         [](SUNLinearSolver s) { SUNLinSolFree(s); }};
  Owned<void> memory_{IDACreate(context_), [](void* m) { IDAFree(&m); }};
  bool good_ = true;
};

class IdaContender final : public Contender {
 public:
  IdaContender(const RunScene& scene, int index, double width) : scene_(scene), index_(index), width_(width) {
    family = width == 0 ? "SUNDIALS, modes" : "SUNDIALS, tanh";
    name = with_width(fmt::format("IDA, index {}", index), width);
    setting = "tolerance";
    settings = tolerances();
  }

  Outcome run(const std::vector<double>& times, double tolerance) const override {
    const auto motion = cartesian_motion(scene_, width_);
    return run_through(scene_, times, *motion, [&](const std::vector<double>& y) {
      return std::make_unique<Ida>(*motion, index_, tolerance, y);
    });
  }

 private:
  const RunScene& scene_;
  int index_;
  double width_;
};

}  // namespace

void add_ida(const RunScene& scene, Contenders& contenders) {
  for (const double width : friction_widths(scene)) {
    contenders.push_back(std::make_unique<IdaContender>(scene, 1, width));
    // Modes end where forces vanish, which index 2 knows too roughly: a hundred times the evaluations of index 1 where
    // it was tried (crank_rocker_offset).
    if (width > 0) contenders.push_back(std::make_unique<IdaContender>(scene, 2, width));
  }
}

}  // namespace slideway::charts

#endif
