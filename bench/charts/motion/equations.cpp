#include "equations.hpp"

#include <cmath>

namespace slideway::charts {
namespace {

Moment<Size> moment(double t, const double* q, const double* v, const Inputs<Size>& inputs, Aim aim, bool at_start) {
  return {t, 0, q, v, inputs, aim, at_start};
}

}  // namespace

RegularisedEquations::RegularisedEquations(const RunScene& scene, double width) : source_(scene), width_(width) {
  for (int g = 0; g < scene.guides; ++g) mu_[g] = scene.guide[g].mu;
  for (int c = 0; c < Size::contacts; ++c) modes_.sign[c] = 1;
  modes_.decided = true;
}

bool RegularisedEquations::accelerate(double t, const double* q, const double* v, double* acceleration,
                                      double* lambda) {
  ++evaluations_;
  const auto& table = source_.tables;
  const Solving solving{{source_.scene.alpha, source_.scene.beta}, {}};
  Work<Size> w;
  Reaction<Size> r;
  Report report;
  const Moment<Size> at = moment(t, q, v, inputs_, Aim::decide, false);
  place(source_, at, solving, w, r);
  signed char mode[Size::guides];
  for (int g = 0; g < source_.scene.guides; ++g) {
    source_.scene.guide[g].mu = mu_[g] * std::tanh(std::fabs(r.slip[g]) / width_);
    mode[g] = r.slip[g] < 0 ? -1 : 1;
  }
  apply_forces(source_, w.kinematics, inputs_, 0, w.dynamics);
  apply_steady_friction(source_, mode, w.friction, w.dynamics);
  gather(source_, w.kinematics, w.dynamics);
  if (!factor_mass(source_, w.kinematics, q, v, w.dynamics)) return false;
  if (!assemble(source_, w.kinematics, w.dynamics, solving.gains, mode, w.friction, r)) return false;
  const bool rests[Size::guides] = {};
  for (int part = 0; part < table.parts; ++part) {
    if (table.first_row[part] == table.first_row[part + 1]) continue;
    if (solve_part<true>(source_, part, at, solving, rests, w, modes_, r, report) != Status::ok) return false;
  }
  resolve(source_, r, w);
  from_metric(source_, w.dynamics, w.u);
  for (int j = 0; j < table.coordinates; ++j) {
    acceleration[j] = table.free_of[j] != none ? w.u[table.free_of[j]] : w.prescribed[j];
  }
  for (int c = 0; c < table.contacts && lambda != nullptr; ++c) {
    lambda[c] = table.is_rough[table.guide_of[c]] ? r.lambda[c] : w.pi[table.row_of[c]];
  }
  return true;
}

ModalEquations::ModalEquations(const RunScene& scene) : stepper_(scene) {}

bool ModalEquations::evaluate(double t, const double* q, const double* v, Aim aim, bool at_start, Modes<Size>& m) {
  ++evaluations_;
  Report report;
  return slideway::accelerate(stepper_.source, moment(t, q, v, inputs_, aim, at_start), stepper_, m, reaction_,
                              report) == Status::ok;
}

/// Which functions are watched: the margin of each guide, the force of each contact whose friction follows it.
bool ModalEquations::decide(double t, const double* q, const double* v, bool at_start) {
  if (!evaluate(t, q, v, Aim::decide, at_start, modes_)) return false;
  const auto& source = stepper_.source;
  modes_.decided = true;
  functions_ = 0;
  for (int i = 0; i < source.tables.rough; ++i) {
    const int c = source.tables.rough_contact[i], g = source.tables.guide_of[c];
    const Guide& guide = source.scene.guide[g];
    if ((modes_.mode[g] != 0 ? guide.mu : guide.mu_static) > 0) watched_[functions_++] = c;
  }
  for (int g = 0; g < source.scene.guides; ++g) {
    modes_.still[g] = modes_.leaving[g] = false;
    if (source.tables.is_rough[g]) watched_[functions_++] = Size::contacts + g;
  }
  return true;
}

bool ModalEquations::begin(double t, const double* q, double* v) {
  modes_ = {};
  return decide(t, q, v, true);
}

bool ModalEquations::accelerate(double t, const double* q, const double* v, double* acceleration) {
  if (!evaluate(t, q, v, Aim::follow, false, modes_)) return false;
  for (int j = 0; j < coordinates(); ++j) acceleration[j] = reaction_.acceleration[j];
  return true;
}

double ModalEquations::value(int i) const {
  if (i < Size::contacts) return modes_.sign[i] < 0 ? -reaction_.lambda[i] : reaction_.lambda[i];
  const int g = i - Size::contacts, mode = modes_.mode[g];
  return mode != 0 ? mode * reaction_.slip[g] : modes_.limit_left[g];
}

bool ModalEquations::values(double t, const double* q, const double* v, double* value_of) {
  if (!evaluate(t, q, v, Aim::follow, false, modes_)) return false;
  for (int k = 0; k < functions_; ++k) value_of[k] = value(watched_[k]);
  return true;
}

bool ModalEquations::pass(double t, const double* q, double* v, const int* zero) {
  double position[Size::coordinates], from[Size::coordinates];
  for (int j = 0; j < coordinates(); ++j) {
    position[j] = q[j];
    from[j] = v[j];
  }
  if (!evaluate(t, q, v, Aim::follow, false, modes_)) return false;
  signed char moves[Size::guides];
  bool stops = false;
  for (int g = 0; g < Size::guides; ++g) moves[g] = 1;
  for (int k = 0; k < functions_; ++k) {
    if (zero[k] == 0) continue;
    const int i = watched_[k];
    if (i < Size::contacts) {
      modes_.sign[i] = static_cast<signed char>(modes_.sign[i] < 0 ? 1 : -1);
      continue;
    }
    const int g = i - Size::contacts;
    modes_.still[g] = stops = true;
    moves[g] = 0;
    if (modes_.mode[g] != 0) {
      modes_.mode[g] = 0;
    } else {
      modes_.mode[g] = reaction_.friction[g] > 0 ? -1 : 1;
      modes_.leaving[g] = true;
    }
  }
  if (stops) Projection<RunTime<Size>>(stepper_.source, inputs_, 0, position, v).arrest(moves, 1e-3, from);
  return decide(t, q, v, false);
}

bool ModalEquations::forces(double t, const double* q, const double* v, double* lambda) {
  Modes<Size> m = modes_;
  if (!evaluate(t, q, v, Aim::follow, false, m)) return false;
  for (int c = 0; c < contacts(); ++c) lambda[c] = reaction_.lambda[c];
  return true;
}

}  // namespace slideway::charts
