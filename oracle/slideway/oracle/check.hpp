// Is what a program says of one instant true? Its accelerations and forces against the oracle's at the same state, and
// its claim of uniqueness against all solutions there.
#pragma once

#include <memory>
#include <slideway/oracle/friction.hpp>
#include <vector>

namespace slideway::oracle {

/// What a program says of an instant: vectors in the scene's order, signs and units as in slideway::Reaction.
struct ClaimedInstant {
  double t = 0;
  std::vector<double> q, v, acceleration;
  std::vector<double> lambda, friction, drive, pin;  ///< pin: x, y of each
  std::vector<int> mode;                             ///< of each guide until then: slip +1, -1; rest 0
  double energy = 0;                                 ///< kinetic + potential, J
};

/// A kind of quantity: the largest error, and what it may be.
struct Shortfall {
  double error = 0;
  double scale = 0;  ///< largest magnitude of the kind
  double bound = 0;  ///< rounding that no program can avoid that is given the state in doubles
};

struct InstantCheck {
  Verdict verdict = Verdict::none;
  bool answered = false;   ///< the oracle has an answer, which the claim was held against
  int solutions = 0;       ///< allowed modes that differ; 0 if there were too many modes to try, too
  bool chosen = false;     ///< forces are a choice: only the claimed ones that follow from the others are compared
  bool certified = false;  ///< W-property, exactly, of the contacts' problem; false if that was not decided
  bool decided = false;    ///< whether it was: at most exact_max_order contacts, all guides slipping
  Shortfall acceleration, lambda, friction, drive, pin, energy;
  int wrong_faces = 0;       ///< contacts whose force, beyond its bound, is on the face that the exact one leaves free
  double coulomb = 0;        ///< largest ||F| - (mu Lambda + preload)| of a slipping guide, over that; exact arithmetic
  bool against_slip = true;  ///< friction of slipping guides never drives
  int beyond_limit = 0;      ///< guides held by more, beyond its bound, than mu_static Lambda + preload
};

class Checker {
 public:
  explicit Checker(const Model<Real>& model);

  /// Rounding that a state in doubles brings. With change_j what an ulp of the largest q or v makes of the answer when
  /// number j of the N numbers in q and v moves by it, a program that is backward stable to `ulps` is off by at most
  /// ulps sum |change_j| <= ulps sqrt(N) sqrt(sum change_j^2), and sqrt(sum change_j^2) is what moving all of them with
  /// mixed signs makes of it, on average; the scene's lengths and masses by an ulp of their own with them. Two patterns
  /// of signs are tried. Each body on a path adds its roundings to the place of what it carries:
  /// bound = ulps (bodies + 1) sqrt(N) change. To accelerations comes what a body's forces leave of them where they
  /// cancel: four roundings of the sum of their magnitudes, over its mass. Baumgarte's terms round speeds by more than
  /// that, unless guides rest: it counts there and without the terms.
  static constexpr int ulps = 8;

  InstantCheck check(const ClaimedInstant& claim);

 private:
  struct Answer {
    std::vector<Real> acceleration, lambda, friction, drive, pin, energy;
  };
  /// A mode with what solve() asks for.
  struct Setting {
    Mode mode;
    Coefficients<Real> mu;
    std::vector<Real> applied;
  };
  static Motion<Real> place(const ClaimedInstant& claim, const Dynamics<Real>& dynamics, int perturbation);
  std::vector<bool> at_rest(const ClaimedInstant& claim, const Motion<Real>& motion);
  Setting as_claimed(const ClaimedInstant& claim, const Solution<Real>& taken, const Coefficients<Real>& mu);
  Real cancelled(const Solution<Real>& taken) const;
  static Answer answer(const Dynamics<Real>& dynamics);
  void check_sliding(const ClaimedInstant& claim, const Solution<Real>& taken, InstantCheck& result) const;
  void check_rest(const ClaimedInstant& claim, const Solution<Real>& taken, InstantCheck& result) const;
  Real limit(const ClaimedInstant& claim, int g, const Real& mu) const;
  void decide_uniqueness(const Mode& mode, const Coefficients<Real>& mu, InstantCheck& result);

  Dynamics<Real> dynamics_;
  FrictionLaw<Real> law_;
  std::vector<std::unique_ptr<Dynamics<Real>>> perturbed_;
};

}  // namespace slideway::oracle
