#include "engines.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "motion/cartesian.hpp"

namespace slideway::charts {

CrankMechanism crank_mechanism(const RunScene& scene, double even_force, double interval) {
  const Guide& guide = scene.guide[0];
  const Body& slider = scene.body[guide.slider];
  bool fits = scene.guides == 1 && scene.drives == 0 && scene.pins == 0 && scene.springs == 0 &&
              scene.joint_springs == 0 && scene.loads == 0 && guide.contacts == 2 && slider.parent != ground &&
              guide.rail != guide.slider && guide.viscous == 0 && guide.preload == 0 && guide.mu == guide.mu_static &&
              guide.tangent.x == 1 && slider.com.x == 0 && slider.com.y == 0 && guide.contact[0].y == 0 &&
              guide.contact[1].y == 0 && guide.contact[0].x == -guide.contact[1].x;
  for (int i = 0; i < scene.bodies; ++i) {
    fits = fits && scene.body[i].joint == Joint::revolute && scene.body[i].angle == 0;
    fits = fits && scene.body[i].parent != guide.slider;
  }
  if (!fits) throw std::invalid_argument("not a crank mechanism with one slider");
  CrankMechanism mechanism{scene, guide.slider, guide.rail, slider.parent, std::fabs(guide.contact[0].x), {}, {}, 0,
                           0,     even_force,   interval};
  double q[Size::bodies], v[Size::bodies];
  for (int i = 0; i < scene.bodies; ++i) {
    q[i] = scene.body[i].q[0];
    v[i] = scene.body[i].v[0];
  }
  CartesianEquations equations(scene);
  equations.from_joints(q, v, mechanism.x, mechanism.u);
  const double* x = mechanism.x;
  Vec2 origin = guide.origin;
  if (guide.rail != ground) {
    const double angle = x[3 * guide.rail + 2];
    origin = Vec2{x[3 * guide.rail], x[3 * guide.rail + 1]} + Rotation{std::cos(angle), std::sin(angle)} * origin;
  }
  mechanism.along = dot(mechanism.tangent(), Vec2{x[3 * guide.slider], x[3 * guide.slider + 1]} - origin);
  mechanism.along_rate = equations.slip(0, mechanism.x, mechanism.u);
  return mechanism;
}

Vec2 CrankMechanism::tangent() const {
  if (rail == ground) return guide().tangent;
  return Rotation{std::cos(x[3 * rail + 2]), std::sin(x[3 * rail + 2])} * guide().tangent;
}

std::vector<double> CrankMechanism::joints(const double* angle) const {
  std::vector<double> q;
  for (int i = 0; i < scene.bodies; ++i) {
    const int parent = scene.body[i].parent;
    q.push_back(angle[i] - (parent == ground ? 0 : angle[parent]));
  }
  return q;
}

double CrankMechanism::bound(double n, double moment) const {
  return guide().mu * std::max(std::fabs(n), std::fabs(moment) / half_length);
}

std::string family_of(const std::string& engine, EngineFriction friction) {
  switch (friction) {
    case EngineFriction::none:
      return engine;
    case EngineFriction::constant:
      return engine + ", constant bound";
    case EngineFriction::last_step:
      return engine + ", last step's force";
    case EngineFriction::contact_pair:
      return engine + ", contacts";
  }
  return engine;
}

std::vector<double> engine_steps(double interval) {
  std::vector<double> steps;
  for (int k = 2; k < 20; ++k) steps.push_back(interval / std::round(std::pow(10, k / 4.0)));
  return steps;
}

}  // namespace slideway::charts
