// What is true of one step on velocities and impulses, for one planar body without drives: by the oracle, in 50 digits.
//
// With q_m = q + h v / 2 the step asks M (v+ - v) = h (forces), N v+ = -(beta / alpha) Phi and Coulomb's law,
// set-valued, in v+. With a = v+ / h that is M a = (forces) + M v / h, N a = -(beta / alpha) Phi / h and the law in a:
// the accelerations of the body at rest at q_m under the additional load M v / h, of which all modes are tried. Phi is
// left out of who rests, as more guides than freedom cannot rest with it, and put in where all slip.
#pragma once

#include "exact_instant.hpp"

namespace slideway::charts {

class ExactJump {
 public:
  ExactJump(const RunScene& scene, const State& state, double h);

  oracle::Verdict verdict() const { return verdict_; }

  /// A step of moreau's that ended with these speeds: right to 1e-9 of the largest there or at the scene's start, and
  /// where it rests to what beta / alpha makes of the drift that its report says.
  Cell judge(const State& after, double drift) const;
  /// A refusal.
  Cell refused(Status status) const;

 private:
  oracle::Verdict verdict_;
  std::vector<double> v_;  ///< at the step's end
  double size_ = 0;        ///< of speeds, m/s and rad/s
  double restoring_;       ///< beta / alpha, 1/s
};

}  // namespace slideway::charts
