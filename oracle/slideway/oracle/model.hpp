// A scene's data in the oracle's number type: exact copies of its doubles; turns and directions computed anew from
// angles and directions, not copied from what the scene derived for the kernel. Every member may be overwritten, so
// that cases whose data are not doubles can be entered.
#pragma once

#include <algorithm>
#include <cmath>
#include <slideway/scene.hpp>
#include <vector>

namespace slideway::oracle {

template <class T>
struct Vec {
  T x, y;
};

/// Members as in slideway::Scene, unless said otherwise.
template <class T>
struct Model {
  struct Body {
    int parent;
    Joint joint;
    Vec<T> at, turn;  ///< turn: (cos, sin) of the joint's fixed angle
    T angle, mass;
    Vec<T> com;
    T inertia;
  };
  struct Guide {
    int slider, rail;
    Vec<T> origin, direction;  ///< direction: of length 1
    std::vector<Vec<T>> contact;
    T mu, mu_static, viscous, preload;
    bool rough() const { return mu_static > 0 || preload > 0; }
  };
  struct Drive {
    int body, axis;
    Law law;
    std::vector<T> c;  ///< of an input: its value, constant over the motion
  };
  struct Pin {
    int a, b;
    Vec<T> a_at, b_at;
  };
  struct Spring {
    int a, b;
    Vec<T> a_at, b_at;
    T stiffness, length, damping;
  };
  struct JointSpring {
    int body;
    T stiffness, rest, damping;
  };
  struct Load {
    int body;
    Vec<T> at, force;
    T torque;
  };
  /// Position q of a coordinate and its speed at the start, body by body.
  struct Start {
    std::vector<T> q, v;
  };

  Vec<T> gravity;
  T alpha, beta;
  std::vector<Body> body;
  std::vector<Guide> guide;
  std::vector<Drive> drive;
  std::vector<Pin> pin;
  std::vector<Spring> spring;
  std::vector<JointSpring> joint_spring;
  std::vector<Load> load;
  Start start;

  int coordinates() const {
    int n = 0;
    for (const Body& b : body) n += slideway::coordinates(b.joint);
    return n;
  }
  int contacts() const {
    int n = 0;
    for (const Guide& g : guide) n += static_cast<int>(g.contact.size());
    return n;
  }
};

/// `inputs`: the constant value of each input of the scene; loads are scaled here.
template <class T, class Size>
Model<T> model_of(const Scene<Size>& scene, const std::vector<double>& inputs = {}) {
  using std::cos, std::sin, std::sqrt;
  const auto vec = [](Vec2 r) { return Vec<T>{T(r.x), T(r.y)}; };
  const auto input = [&](int i) {
    return static_cast<std::size_t>(i) < inputs.size() ? T(inputs[static_cast<std::size_t>(i)]) : T(0);
  };
  Model<T> m;
  m.gravity = vec(scene.gravity);
  m.alpha = T(scene.alpha);
  m.beta = T(scene.beta);
  for (int i = 0; i < scene.bodies; ++i) {
    const slideway::Body& b = scene.body[i];
    const T angle(b.angle);
    m.body.push_back(
        {b.parent, b.joint, vec(b.at), {T(cos(angle)), T(sin(angle))}, angle, T(b.mass), vec(b.com), T(b.inertia)});
    for (int k = 0; k < coordinates(b.joint); ++k) {
      m.start.q.push_back(T(b.q[k]));
      m.start.v.push_back(T(b.v[k]));
    }
  }
  for (int i = 0; i < scene.guides; ++i) {
    const slideway::Guide& g = scene.guide[i];
    const T dx(g.direction.x), dy(g.direction.y), length = sqrt(T(dx * dx + dy * dy));
    m.guide.push_back({g.slider,
                       g.rail,
                       vec(g.origin),
                       {T(dx / length), T(dy / length)},
                       {},
                       T(g.mu),
                       T(g.mu_static),
                       T(g.viscous),
                       T(g.preload)});
    for (int k = 0; k < g.contacts; ++k) m.guide.back().contact.push_back(vec(g.contact[k]));
  }
  for (int i = 0; i < scene.drives; ++i) {
    const slideway::Drive& d = scene.drive[i];
    m.drive.push_back({d.body, d.axis, d.law, {}});
    if (d.law == Law::input) m.drive.back().c = {input(d.input)};
    const int terms = d.law == Law::uniform ? 2 : d.law == Law::harmonic ? 4 : d.law == Law::polynomial ? d.terms : 0;
    for (int k = 0; k < terms; ++k) m.drive.back().c.push_back(T(d.c[k]));
  }
  for (int i = 0; i < scene.pins; ++i) {
    const slideway::Pin& p = scene.pin[i];
    m.pin.push_back({p.a, p.b, vec(p.a_at), vec(p.b_at)});
  }
  for (int i = 0; i < scene.springs; ++i) {
    const slideway::Spring& s = scene.spring[i];
    m.spring.push_back({s.a, s.b, vec(s.a_at), vec(s.b_at), T(s.stiffness), T(s.length), T(s.damping)});
  }
  for (int i = 0; i < scene.joint_springs; ++i) {
    const slideway::JointSpring& s = scene.joint_spring[i];
    m.joint_spring.push_back({s.body, T(s.stiffness), T(s.rest), T(s.damping)});
  }
  for (int i = 0; i < scene.loads; ++i) {
    const slideway::Load& l = scene.load[i];
    const T factor = l.input == none ? T(1) : input(l.input);
    m.load.push_back(
        {l.body, vec(l.at), {T(factor * T(l.force.x)), T(factor * T(l.force.y))}, T(factor * T(l.torque))});
  }
  return m;
}

/// Coefficients 0 .. orders - 1 of a drive's law in tau, for time t + tau.
template <class T>
std::vector<T> law_series(const typename Model<T>::Drive& drive, const T& t, int orders) {
  using std::cos, std::sin;
  std::vector<T> f(std::max(static_cast<std::size_t>(orders), drive.c.size()), T(0));
  if (drive.law == Law::input) {
    f[0] = drive.c[0];
  } else if (drive.law == Law::harmonic) {
    const T phase = drive.c[2] * t + drive.c[3], s = sin(phase), c = cos(phase);
    T factor = drive.c[1];  // amplitude frequency^k / k!
    for (std::size_t k = 0; k < f.size(); ++k) {
      f[k] = factor * (k % 4 == 0 ? s : k % 4 == 1 ? c : k % 4 == 2 ? T(-s) : T(-c));
      factor *= drive.c[2] / T(static_cast<int>(k) + 1);
    }
    f[0] += drive.c[0];
  } else {
    std::copy(drive.c.begin(), drive.c.end(), f.begin());
    for (std::size_t done = 0; done + 1 < drive.c.size(); ++done) {  // Taylor's shift by t, a Horner pass a coefficient
      for (std::size_t k = drive.c.size() - 1; k-- > done;) f[k] += t * f[k + 1];
    }
  }
  f.resize(static_cast<std::size_t>(orders));
  return f;
}

}  // namespace slideway::oracle
