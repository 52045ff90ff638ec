// A scene's equations of motion for a general integrator: the kernel's own, so that no formulation of a user's is
// cheaper, with friction regularised as users do, or in frozen modes.
#pragma once

#include <slideway/io/stepper.hpp>

namespace slideway::charts {

using Size = io::RunSize;
using RunScene = Scene<Size>;

/// F = -mu Lambda tanh(v / width) in place of Coulomb's law: smooth where v passes zero, and never at rest. Lambda is
/// the sum of the contact forces' magnitudes, which follow from the same HLCP with mu tanh for mu.
class RegularisedEquations {
 public:
  RegularisedEquations(const RunScene& scene, double width);

  /// q'' and, if wanted, contact forces. False where the equations have no solution.
  bool accelerate(double t, const double* q, const double* v, double* acceleration, double* lambda = nullptr);

  int coordinates() const { return source_.tables.coordinates; }
  int contacts() const { return source_.tables.contacts; }
  long evaluations() const { return evaluations_; }

 private:
  RunTime<Size> source_;
  double mu_[Size::guides];
  double width_;
  Modes<Size> modes_ = {};
  Inputs<Size> inputs_ = {};
  long evaluations_ = 0;
};

/// In frozen modes, each with functions that are positive while it lasts, as events.hpp has them; decided anew where
/// one vanishes.
class ModalEquations {
 public:
  explicit ModalEquations(const RunScene& scene);

  /// Modes at the start; false where Coulomb's law has no single answer.
  bool begin(double t, const double* q, double* v);
  /// q'' in the modes; false where they have none.
  bool accelerate(double t, const double* q, const double* v, double* acceleration);
  /// Functions that are watched in these modes, and their values at the last accelerate() or at (t, q, v).
  int functions() const { return functions_; }
  bool values(double t, const double* q, const double* v, double* value);
  /// The modes after the functions in `zero` have vanished. v is set to rest where guides stick.
  bool pass(double t, const double* q, double* v, const int* zero);
  bool forces(double t, const double* q, const double* v, double* lambda);

  const Modes<Size>& modes() const { return modes_; }
  /// Contact, or Size::contacts + guide, of a function.
  int watched(int function) const { return watched_[function]; }
  int coordinates() const { return stepper_.source.tables.coordinates; }
  int contacts() const { return stepper_.source.tables.contacts; }
  long evaluations() const { return evaluations_; }

 private:
  bool evaluate(double t, const double* q, const double* v, Aim aim, bool at_start, Modes<Size>& m);
  bool decide(double t, const double* q, const double* v, bool at_start);
  double value(int i) const;

  io::RunStepper stepper_;
  Modes<Size> modes_ = {};
  Reaction<Size> reaction_ = {};
  Inputs<Size> inputs_ = {};
  int watched_[Size::contacts + Size::guides];  ///< contacts, then guides
  int functions_ = 0;
  long evaluations_ = 0;
};

}  // namespace slideway::charts
