// General engines of multibody dynamics on a crank mechanism: MuJoCo, ODE, Simbody, each with the closest model that it
// can express. Their mechanisms are made of joints: bodies on hinges along z, and a slider on a rail by a slide joint,
// joined to its crank or rod by a closed loop.
#pragma once

#include <cmath>

#include "motion/contender.hpp"

namespace slideway::charts {

/// How an engine's slider is held back.
enum class EngineFriction {
  none,         ///< mu = 0: a model that all express
  constant,     ///< a bound that stays, and does as much work as friction in the exact run: the user knows that
  last_step,    ///< a bound that is set before each step: mu times that sum, from the slide joint's force in the last
  contact_pair  ///< no slide joint: contacts on both sides of a slot, at the scene's contact points
};

/// A scene with one guide, along its rail's x axis, of two contacts on the slider's, symmetric about its origin and
/// centre of mass, whose slider turns on another body.
struct CrankMechanism {
  const RunScene& scene;
  int slider, rail, carrier;                        ///< bodies; the carrier is what the slider turns on
  double half_length;                               ///< m: of the contacts from the slider's origin
  double x[3 * Size::bodies], u[3 * Size::bodies];  ///< start: x, y, angle body by body, and their rates
  double along, along_rate;                         ///< start of the slide joint: m from the guide's origin, m/s
  double even_force;  ///< N: constant sum of contact forces whose friction does as much work in the exact run
  double interval;    ///< s between samples

  const Guide& guide() const { return scene.guide[0]; }
  Vec2 tangent() const;  ///< of the rail at the start, world's frame
  /// Joint coordinates of bodies at these angles.
  std::vector<double> joints(const double* angle) const;
  /// The bound of friction that belongs to the force n and the moment on the slider about its origin: the contacts
  /// carry (n -+ moment / half_length) / 2.
  double bound(double n, double moment) const;
};

/// invalid_argument if the scene is another.
CrankMechanism crank_mechanism(const RunScene& scene, double even_force, double interval);

struct Engine {
  std::string name, version;  ///< version empty: missing when this was built
  std::string cannot;         ///< what of a guide with Coulomb's friction it cannot express
  std::string in_short;       ///< the same in 36 characters, for the chart
  void (*add)(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders);
  std::vector<EngineFriction> frictions;  ///< that it has, but for none
};

Engine mujoco_engine();
Engine ode_engine();
Engine simbody_engine();

/// Family of an engine's contenders.
std::string family_of(const std::string& engine, EngineFriction friction);

/// A contender with a model of its own that is made once: `Model` has
///     start(setting)                          sets it to its start
///     step(h)                                 false if the engine failed
///     angles(double*)                         absolute, by body, in whole turns or not
template <class Model>
class SteppedEngine final : public Contender {
 public:
  template <class... Arguments>
  SteppedEngine(const CrankMechanism& mechanism, const std::string& of_family, const std::string& how,
                const Arguments&... arguments)
      : mechanism_(mechanism), model_(std::make_unique<Model>(mechanism, arguments...)) {
    family = of_family;
    name = how;
    setting = "step";
  }

  Outcome run(const std::vector<double>& times, double h_most) const override {
    Outcome outcome;
    double angle[Size::bodies];
    for (int i = 0; i < mechanism_.scene.bodies; ++i) angle[i] = mechanism_.x[3 * i + 2];
    model_->start(h_most);
    double from = 0;
    for (const double to : times) {
      const long steps = std::lround((to - from) / h_most);
      const double h = (to - from) / static_cast<double>(steps);
      for (long k = 0; k < steps; ++k) {
        if (model_->step(h)) continue;
        outcome.failure = "the engine failed";
        return outcome;
      }
      outcome.evaluations += steps;
      double now[Size::bodies];
      model_->angles(now);
      for (int i = 0; i < mechanism_.scene.bodies; ++i) {  // the turn that is nearest to the last sample's
        angle[i] = now[i] + two_pi * std::round((angle[i] - now[i]) / two_pi);
      }
      outcome.q.push_back(mechanism_.joints(angle));
      outcome.lambda.emplace_back();  // not asked for
      from = to;
    }
    return outcome;
  }

 private:
  static constexpr double two_pi = 6.283185307179586;

  const CrankMechanism& mechanism_;
  std::unique_ptr<Model> model_;
};

/// Steps that divide `interval`, four a decade.
std::vector<double> engine_steps(double interval);

}  // namespace slideway::charts
