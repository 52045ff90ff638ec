// SUNDIALS' CVODE and IDA (Hindmarsh and others, ACM Trans. Math. Software 31, 2005), as these tests use them: one
// object for each stretch of motion between two events, its root functions positive inside.
#pragma once

#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/Dense>
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <sundials/sundials_context.hpp>
#include <vector>

namespace slideway::test {

using Vector = std::vector<double>;

struct Event {
  double t;
  std::string where, kind;  ///< "guide 0" or "contact 1", as the scene numbers them; kind as the oracle names it
};

/// A mechanism's motion, mode by mode. Tolerances are relative to y and, where it is small, to `unit`.
class Motion {
 public:
  virtual ~Motion() = default;

  virtual int conditions() const = 0;  ///< how many margins are >= 0 while the mode lasts
  virtual void margins(double t, const double* y, double* margin) = 0;
  /// The mode after t, at which these conditions fail.
  virtual void change_mode(const std::vector<int>& failed) = 0;
  /// The joints' coordinates and then their speeds, as the scene orders them.
  virtual Vector joints() = 0;

  double t = 0;
  Vector y, unit;
  std::vector<Event> events;
};

/// y' = rates(t, y).
class OdeMotion : public Motion {
 public:
  virtual void rates(double t, const double* y, double* dy) = 0;
};

/// 0 = residual(t, y, y'), of index 1; the differential components of y come first.
class DaeMotion : public Motion {
 public:
  virtual void residual(double t, const double* y, const double* dy, double* r) = 0;
  virtual int differential() const = 0;  ///< how many
};

namespace detail {

inline void check(int flag) {  // SUNDIALS itself says more, on standard error
  if (flag < 0) throw std::runtime_error("SUNDIALS returns " + std::to_string(flag));
}

/// What the solvers are told of a call back: no exception passes through C.
template <class F>
int answer(F call) noexcept {
  try {
    call();
    return 0;
  } catch (const std::exception&) {
    return -1;
  }
}

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;
using OwnedVector = Owned<std::remove_pointer_t<N_Vector>>;

/// What both solvers need: storage and a dense linear solver for n unknowns.
struct Storage {
  explicit Storage(std::size_t size)
      : n(static_cast<sunindextype>(size)),
        matrix(SUNDenseMatrix(n, n, context), SUNMatDestroy),
        y(vector()),
        dy(vector()),
        other(vector()),
        linear(SUNLinSol_Dense(y.get(), matrix.get(), context), [](SUNLinearSolver s) { SUNLinSolFree(s); }) {}

  OwnedVector vector() const { return {N_VNew_Serial(n, context), N_VDestroy}; }
  static void set(const OwnedVector& to, const Vector& from) {
    std::copy(from.begin(), from.end(), N_VGetArrayPointer(to.get()));
  }
  static void get(const OwnedVector& from, Vector& to) {
    std::copy_n(N_VGetArrayPointer(from.get()), to.size(), to.begin());
  }
  void set_absolute(const Vector& unit, double tolerance) {
    std::transform(unit.begin(), unit.end(), N_VGetArrayPointer(other.get()), [=](double u) { return tolerance * u; });
  }

  sundials::Context context;
  sunindextype n;
  Owned<std::remove_pointer_t<SUNMatrix>> matrix;
  OwnedVector y, dy, other;
  Owned<std::remove_pointer_t<SUNLinearSolver>> linear;
};

/// Which conditions have failed, of `found` as the solvers report roots.
inline std::vector<int> failed(const std::vector<int>& found) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] != 0) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

constexpr long most_steps = 1000000;

}  // namespace detail

/// Adams' methods to `end`, or to the first time at which conditions fail: these are returned.
inline std::vector<int> advance(OdeMotion& motion, double end, double tolerance) {
  using detail::check;
  detail::Storage store(motion.y.size());
  store.set(store.y, motion.y);
  store.set_absolute(motion.unit, tolerance);
  std::unique_ptr<void, void (*)(void*)> solver(CVodeCreate(CV_ADAMS, store.context), [](void* s) { CVodeFree(&s); });
  const auto rates = [](realtype t, N_Vector y, N_Vector dy, void* self) {
    return detail::answer(
        [&] { static_cast<OdeMotion*>(self)->rates(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)); });
  };
  const auto margins = [](realtype t, N_Vector y, realtype* margin, void* self) {
    return detail::answer([&] { static_cast<OdeMotion*>(self)->margins(t, N_VGetArrayPointer(y), margin); });
  };
  check(CVodeInit(solver.get(), rates, motion.t, store.y.get()));
  check(CVodeSetUserData(solver.get(), &motion));
  check(CVodeSVtolerances(solver.get(), tolerance, store.other.get()));
  check(CVodeSetLinearSolver(solver.get(), store.linear.get(), store.matrix.get()));
  check(CVodeSetMaxNumSteps(solver.get(), detail::most_steps));
  check(CVodeSetStopTime(solver.get(), end));
  const int conditions = motion.conditions();
  std::vector<int> falling(static_cast<std::size_t>(conditions), -1), found(falling.size(), 0);
  check(CVodeRootInit(solver.get(), conditions, margins));
  if (conditions > 0) check(CVodeSetRootDirection(solver.get(), falling.data()));
  check(CVodeSetNoInactiveRootWarn(solver.get()));

  const int flag = CVode(solver.get(), end, store.y.get(), &motion.t, CV_NORMAL);
  check(flag);
  if (flag == CV_ROOT_RETURN) check(CVodeGetRootInfo(solver.get(), found.data()));
  store.get(store.y, motion.y);
  return detail::failed(found);
}

/// Rates, and algebraic components of motion.y, from its differential ones: the residual is affine in both, so that one
/// solve finds them. (IDACalcIC iterates, and is stopped by rounding where forces are large.)
inline Vector make_consistent(DaeMotion& motion) {
  const auto n = static_cast<Eigen::Index>(motion.y.size());
  const auto differential = static_cast<std::size_t>(motion.differential());
  const auto residual = [&](const Eigen::VectorXd& x) {
    Vector y = motion.y, dy(y.size(), 0);
    for (std::size_t i = 0; i < y.size(); ++i) (i < differential ? dy : y)[i] = x(static_cast<Eigen::Index>(i));
    Eigen::VectorXd r(n);
    motion.residual(motion.t, y.data(), dy.data(), r.data());
    return r;
  };
  const Eigen::VectorXd at_zero = residual(Eigen::VectorXd::Zero(n));
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) matrix.col(i) = residual(Eigen::VectorXd::Unit(n, i)) - at_zero;
  const Eigen::VectorXd x = -matrix.partialPivLu().solve(at_zero);
  Vector dy(motion.y.size(), 0);
  for (std::size_t i = 0; i < dy.size(); ++i) (i < differential ? dy : motion.y)[i] = x(static_cast<Eigen::Index>(i));
  return dy;
}

/// Backward differences to `end`, or to the first time at which conditions fail: from the differential part of
/// motion.y: the rest is made consistent first.
inline std::vector<int> advance(DaeMotion& motion, double end, double tolerance) {
  using detail::check;
  const Vector rates = make_consistent(motion);
  detail::Storage store(motion.y.size());
  store.set(store.y, motion.y);
  store.set(store.dy, rates);
  store.set_absolute(motion.unit, tolerance);
  std::unique_ptr<void, void (*)(void*)> solver(IDACreate(store.context), [](void* s) { IDAFree(&s); });
  const auto residual = [](realtype t, N_Vector y, N_Vector dy, N_Vector r, void* self) {
    return detail::answer([&] {
      static_cast<DaeMotion*>(self)->residual(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy), N_VGetArrayPointer(r));
    });
  };
  const auto margins = [](realtype t, N_Vector y, N_Vector, realtype* margin, void* self) {
    return detail::answer([&] { static_cast<DaeMotion*>(self)->margins(t, N_VGetArrayPointer(y), margin); });
  };
  check(IDAInit(solver.get(), residual, motion.t, store.y.get(), store.dy.get()));
  check(IDASetUserData(solver.get(), &motion));
  check(IDASVtolerances(solver.get(), tolerance, store.other.get()));
  check(IDASetLinearSolver(solver.get(), store.linear.get(), store.matrix.get()));
  check(IDASetMaxNumSteps(solver.get(), detail::most_steps));
  check(IDASetStopTime(solver.get(), end));
  const int conditions = motion.conditions();
  std::vector<int> falling(static_cast<std::size_t>(conditions), -1), found(falling.size(), 0);
  check(IDARootInit(solver.get(), conditions, margins));
  if (conditions > 0) check(IDASetRootDirection(solver.get(), falling.data()));
  check(IDASetNoInactiveRootWarn(solver.get()));

  const int flag = IDASolve(solver.get(), end, &motion.t, store.y.get(), store.dy.get(), IDA_NORMAL);
  check(flag);
  if (flag == IDA_ROOT_RETURN) check(IDAGetRootInfo(solver.get(), found.data()));
  store.get(store.y, motion.y);
  return detail::failed(found);
}

/// From t = 0, in as many modes as it takes.
template <class SomeMotion>
void run(SomeMotion& motion, double duration, double tolerance) {
  constexpr int most_modes = 200;
  for (int mode = 0; motion.t < duration; ++mode) {
    if (mode == most_modes) throw std::runtime_error("more events than these motions have");
    const std::vector<int> failed = advance(motion, duration, tolerance);
    if (!failed.empty()) motion.change_mode(failed);
  }
}

}  // namespace slideway::test
