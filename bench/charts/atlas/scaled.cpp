#include "scaled.hpp"

#include <cmath>

namespace slideway::charts {
namespace {

bool turns(const Body& body, int axis) {
  return body.joint == Joint::revolute || (body.joint == Joint::planar && axis == 2);
}

void scale(Vec2& r, double by) { r = {by * r.x, by * r.y}; }

double power(double x, int n) {
  double value = 1;
  for (int k = 0; k < std::abs(n); ++k) value *= x;
  return n < 0 ? 1 / value : value;
}

}  // namespace

double Units::of(int a, int b, int c) const { return power(m, a) * power(kg, b) * power(s, c); }

RunScene in_units(RunScene scene, const Units& u) {
  const double newton = u.of(1, 1, -2);
  scale(scene.gravity, u.of(1, 0, -2));
  scene.alpha *= u.of(0, 0, -1);
  scene.beta *= u.of(0, 0, -2);
  for (int i = 0; i < scene.bodies; ++i) {
    Body& body = scene.body[i];
    scale(body.at, u.m);
    scale(body.com, u.m);
    body.mass *= u.kg;
    body.inertia *= u.of(2, 1, 0);
    for (int k = 0; k < coordinates(body.joint); ++k) {
      body.q[k] *= turns(body, k) ? 1 : u.m;
      body.v[k] *= turns(body, k) ? u.of(0, 0, -1) : u.of(1, 0, -1);
    }
  }
  for (int g = 0; g < scene.guides; ++g) {
    Guide& guide = scene.guide[g];
    for (Vec2* r : {&guide.origin, &guide.contact[0], &guide.contact[1]}) scale(*r, u.m);
    guide.viscous *= u.of(0, 1, -1);
    guide.preload *= newton;
  }
  for (int d = 0; d < scene.drives; ++d) {
    Drive& drive = scene.drive[d];
    const double size = turns(scene.body[drive.body], drive.axis) ? 1 : u.m;
    if (drive.law == Law::harmonic) {
      drive.c[0] *= size;
      drive.c[1] *= size;
      drive.c[2] *= u.of(0, 0, -1);
    } else {
      for (int k = 0; k < 8; ++k) drive.c[k] *= size * u.of(0, 0, -k);
    }
  }
  for (int p = 0; p < scene.pins; ++p) {
    scale(scene.pin[p].a_at, u.m);
    scale(scene.pin[p].b_at, u.m);
  }
  for (int k = 0; k < scene.springs; ++k) {
    Spring& spring = scene.spring[k];
    scale(spring.a_at, u.m);
    scale(spring.b_at, u.m);
    spring.length *= u.m;
    spring.stiffness *= u.of(0, 1, -2);
    spring.damping *= u.of(0, 1, -1);
  }
  for (int l = 0; l < scene.loads; ++l) {
    Load& load = scene.load[l];
    scale(load.at, u.m);
    scale(load.force, newton);
    load.torque *= u.of(2, 1, -2);
  }
  return scene;
}

std::vector<double> in_si(const io::RunStepper& stepper, const io::RunStepper::State& state, const Units& u) {
  std::vector<double> numbers;
  const auto& scene = stepper.source.scene;
  for (int i = 0, j = 0; i < scene.bodies; ++i) {
    for (int k = 0; k < coordinates(scene.body[i].joint); ++k, ++j) {
      const int a = turns(scene.body[i], k) ? 0 : 1;
      numbers.push_back(state.q[j] / u.of(a, 0, 0));
      numbers.push_back(state.v[j] / u.of(a, 0, -1));
    }
  }
  io::RunStepper::Reaction r;
  if (stepper.reaction(state, {}, r).status != Status::ok) return {};
  for (int c = 0; c < stepper.source.tables.contacts; ++c) numbers.push_back(r.lambda[c] / u.of(1, 1, -2));
  for (int g = 0; g < scene.guides; ++g) numbers.push_back(r.friction[g] / u.of(1, 1, -2));
  return numbers;
}

}  // namespace slideway::charts
