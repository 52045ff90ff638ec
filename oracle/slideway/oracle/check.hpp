// Is what a program says of one instant true? Its accelerations and forces against the oracle's at the same state, and
// its claim of uniqueness against all solutions there.
#pragma once

#include <slideway/oracle/friction.hpp>
#include <vector>

namespace slideway::oracle {

/// What a program says of an instant: vectors in the scene's order, signs and units as in slideway::Reaction.
struct ClaimedInstant {
  double t = 0;
  std::vector<double> q, v, acceleration;
  std::vector<double> lambda, friction, drive, pin;  ///< pin: x, y of each
  std::vector<int> mode;                             ///< of each guide: slip +1, -1; rest 0
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
  bool certified = false;  ///< W-property, exactly, of the contacts' problem; false if that was not decided
  bool decided = false;    ///< whether it was: at most exact_max_order contacts, all guides slipping
  Shortfall acceleration, lambda, friction, drive, pin, energy;
  int wrong_faces = 0;       ///< contacts whose force, beyond its bound, is on the face that the exact one leaves free
  double coulomb = 0;        ///< largest ||F| - (mu Lambda + preload)| of a slipping guide, over that; exact arithmetic
  bool against_slip = true;  ///< friction of slipping guides never drives
};

class Checker {
 public:
  explicit Checker(const Model<Real>& model);

  /// Rounding that a state in doubles brings. With change_j what an ulp of the largest q or v makes of the answer when
  /// number j of the N numbers in q and v moves by it, a program that is backward stable to `ulps` is off by at most
  /// ulps sum |change_j| <= ulps sqrt(N) sqrt(sum change_j^2), and sqrt(sum change_j^2) is what moving all of them with
  /// mixed signs makes of it, on average. Two patterns of signs are tried. Each body on a path adds its roundings to
  /// the place of what it carries: bound = ulps (bodies + 1) sqrt(N) change.
  static constexpr int ulps = 8;

  InstantCheck check(const ClaimedInstant& claim);

 private:
  struct Answer {
    std::vector<Real> acceleration, lambda, friction, drive, pin, energy;
  };
  Motion<Real> place(const ClaimedInstant& claim, int perturbation) const;
  Answer answer() const;
  void check_claims(const ClaimedInstant& claim, InstantCheck& result) const;
  void decide_uniqueness(const Mode& mode, const Coefficients<Real>& mu, InstantCheck& result);

  mutable Dynamics<Real> dynamics_;
  FrictionLaw<Real> law_;
};

}  // namespace slideway::oracle
