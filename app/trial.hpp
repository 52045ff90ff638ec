// A scene's first steps, and how far those of two scenes are apart.
#pragma once

#include <memory>
#include <slideway/io/stepper.hpp>
#include <vector>

namespace slideway::app {

/// How a scene is tried.
struct TrialPlan {
  Method method = Method::rk4;
  double dt = 1e-3;  ///< s
  int steps = 0;
};

/// What came of it. Of each body the place of its centre of mass and its turn (cosine, sine), of each guide its contact
/// forces together and friction, of each drive its force: at the start and after every step.
struct Trial {
  int steps = 0;                       ///< that were made
  double evaluations = 0;              ///< a step, of accelerations and forces
  double drift = 0;                    ///< largest miss of a constraint, m or rad
  double dissipated = 0, in_play = 0;  ///< J
  double length = 1;                   ///< the scene's, m
  std::vector<double> places, turns, contacts, drives;
};

Trial run_trial(const Scene<io::RunSize>& scene, const TrialPlan& plan);

/// Largest differences: of places and turns over the length of the scene (a turn: in radians), of forces over the
/// largest of them. Turns of the bodies `without_turn` do not count.
struct Apart {
  double places = 0, contacts = 0, drives = 0;
  double largest() const;
};
Apart apart(const Trial& one, const Trial& other, const std::vector<int>& without_turn);

/// Time of a step of `other` over that of `one`: least of some runs that take turns.
double time_ratio(const Scene<io::RunSize>& one, const TrialPlan& plan_of_one, const Scene<io::RunSize>& other,
                  const TrialPlan& plan_of_other);

}  // namespace slideway::app
