// What is true of one instant of a scene: by the oracle, in 50 digits. Who is judged says forces, or refuses.
#pragma once

#include <memory>
#include <slideway/io/stepper.hpp>
#include <slideway/oracle/check.hpp>
#include <vector>

#include "atlas.hpp"

namespace slideway::charts {

using State = io::RunStepper::State;

/// The contact forces' problem S x + S* |x| = b at a state, all guides slipping: what others solve in their ways.
struct ContactProblem {
  int n = 0;
  std::vector<double> S, S_star, b;  ///< row by row
};

class ExactInstant {
 public:
  ExactInstant(const RunScene& scene, const State& state);

  /// The kernel's answer at the state. Right: forces and accelerations within `tolerance` of the largest, or four times
  /// the oracle's bound on what rounding a state in doubles brings (it tries two patterns of signs, others exceed it by
  /// less), as long as that leaves a digit. Refused rightly: there is no solution (`no_solution`), there are several
  /// (`not_unique`), or rank is lost, or so near to it that rounding the state changes the answer by a tenth of itself
  /// or the contacts' matrix S cannot be told from a singular one in doubles.
  Cell judge(const io::RunStepper& stepper, double tolerance = 1e-12) const;

  /// Somebody's contact forces; none: a refusal.
  Cell judge(const std::vector<double>& lambda, double tolerance) const;

  /// What a refusal by the kernel is.
  Cell refused(Status status) const;

  bool is_unique() const { return verdict_ == oracle::Verdict::unique; }
  bool is_ambiguous() const;
  /// Largest error of contact forces, over the largest force.
  double relative_error(const std::vector<double>& lambda) const;
  /// What rounding the state makes of them, over the largest.
  double relative_bound() const { return relative_bound_; }

  /// False if what is left without contacts is singular.
  bool problem(ContactProblem& problem) const;

 private:
  oracle::ClaimedInstant claim(const std::vector<double>& lambda) const;
  bool has_no_digits() const;

  State state_;
  oracle::Model<oracle::Real> model_;
  mutable oracle::Checker checker_;
  mutable oracle::Dynamics<oracle::Real> dynamics_;
  oracle::Mode mode_;
  oracle::Coefficients<oracle::Real> mu_;
  std::vector<int> slips_;
  oracle::Verdict verdict_ = oracle::Verdict::none;
  int solutions_ = 0;
  double relative_bound_ = 0;
  bool lost_rank_ = false;
};

}  // namespace slideway::charts
