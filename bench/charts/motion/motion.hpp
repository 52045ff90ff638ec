// What a general integrator is given: a scene's motion as y' = f(t, y) or as residuals, with functions whose zeros end
// a mode, and how it is taken through the times asked for.
#pragma once

#include <functional>

#include "cartesian.hpp"
#include "contender.hpp"

namespace slideway::charts {

/// y = (positions, speeds), n each.
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

/// y = (x, y, angle body by body; their rates): a user's own equations.
class CartesianMotion : public Motion {
 public:
  explicit CartesianMotion(const RunScene& scene);
  bool begin(const double* q, const double* v, double* y) override;
  bool rates(double t, const double* y, double* dy) override;
  bool look(double t, const double* y, double* q, double* lambda) override;
  long evaluations() const override { return evaluations_; }

  /// For implicit solvers: forces that are unknown beside y, enough for all modes; those that are not used are zero.
  int forces() const { return forces_; }
  /// Those of the last rates().
  void copy_forces(double* force) const;
  /// CartesianEquations' residual at y, accelerations and forces; the equations then hold Phi and its rate.
  void residual(double t, const double* y, const double* acceleration, const double* force, double* left);
  /// As values(), of forces that are known.
  virtual void values_of(const double*, const double*, double*) const {}
  const CartesianEquations& equations() const { return equations_; }

 protected:
  /// Friction of the guides; false: `sign` of contact forces follows from these, true: it is set here.
  virtual bool frictions(const double* y, GuideFriction* friction) = 0;

  const RunScene& scene_;
  CartesianEquations equations_;
  int contacts_, forces_;
  signed char sign_[Size::contacts];
  long evaluations_ = 0;
};

/// Friction by tanh(slip / width), m/s; width 0: in modes, which slideway decides.
std::unique_ptr<CartesianMotion> cartesian_motion(const RunScene& scene, double width);
/// The same by slideway's own equations, in joint coordinates.
std::unique_ptr<Motion> lent_motion(const RunScene& scene, double width);

/// From t on over y; begun anew after every event.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual double* data() = 0;  ///< y
  /// To `end`, or to where functions vanish (`zero` then says which). False when it gives up.
  virtual bool advance(double end, double& t, std::vector<int>& zero, bool& event) = 0;
  /// y has jumped to another mode.
  virtual bool restart(double t) = 0;
};

using MakeIntegrator = std::function<std::unique_ptr<Integrator>(const std::vector<double>& y)>;
Outcome run_through(const RunScene& scene, const std::vector<double>& times, Motion& motion,
                    const MakeIntegrator& make);

/// Widths of tanh that are tried, m/s; 0, modes with root finding, first.
std::vector<double> friction_widths(const RunScene& scene);
/// "tanh(v / 0.01 m/s)", or nothing for modes, after the solver's name.
std::string with_width(const std::string& solver, double width);
/// 1e-2 to 1e-13.
std::vector<double> tolerances();

/// Nothing where IDA was not found.
void add_ida(const RunScene& scene, Contenders& contenders);

}  // namespace slideway::charts
