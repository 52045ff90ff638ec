#include <algorithm>
#include <cmath>
#include <slideway/properties/symmetry.hpp>

namespace slideway::properties {
namespace {

/// f(body, axis, j) for every coordinate j.
template <class F>
void for_each_coordinate(const MechanismScene& scene, F f) {
  for (int i = 0, j = 0; i < scene.bodies; ++i) {
    for (int k = 0; k < coordinates(scene.body[i].joint); ++k, ++j) f(i, k, j);
  }
}

/// Whether a body's coordinate k is an angle.
bool turns(const Body& body, int k) { return body.joint == Joint::revolute || (body.joint == Joint::planar && k == 2); }

void flip(double& x) { x = -x; }

Vec2 quarter(Vec2 r) { return {-r.y, r.x}; }

}  // namespace

Seen mirrored(const MechanismScene& scene) {
  MechanismScene s = scene;
  flip(s.gravity.y);
  const auto changes = [](const Body& body, int k) {
    return turns(body, k) || (body.joint == Joint::planar && k == 1);
  };
  for (int i = 0; i < s.bodies; ++i) {
    Body& body = s.body[i];
    flip(body.at.y);
    flip(body.angle);
    flip(body.turn.y);
    flip(body.com.y);
    for (int k = 0; k < coordinates(body.joint); ++k) {
      if (!changes(body, k)) continue;
      flip(body.q[k]);
      flip(body.v[k]);
    }
  }
  for (int g = 0; g < s.guides; ++g) {
    for (Vec2* r : {&s.guide[g].origin, &s.guide[g].direction, &s.guide[g].tangent, &s.guide[g].contact[0],
                    &s.guide[g].contact[1]}) {
      flip(r->y);
    }
  }
  for (int d = 0; d < s.drives; ++d) {
    Drive& drive = s.drive[d];
    if (!changes(s.body[drive.body], drive.axis)) continue;
    const int signed_terms = drive.law == Law::harmonic ? 2 : 8;  // not its frequency and phase
    for (int k = 0; k < signed_terms; ++k) flip(drive.c[k]);
  }
  for (int p = 0; p < s.pins; ++p) {
    flip(s.pin[p].a_at.y);
    flip(s.pin[p].b_at.y);
  }
  for (int k = 0; k < s.springs; ++k) {
    flip(s.spring[k].a_at.y);
    flip(s.spring[k].b_at.y);
  }
  for (int k = 0; k < s.joint_springs; ++k) {
    if (turns(s.body[s.joint_spring[k].body], 0)) flip(s.joint_spring[k].rest);
  }
  for (int l = 0; l < s.loads; ++l) {
    flip(s.load[l].at.y);
    flip(s.load[l].force.y);
    flip(s.load[l].torque);
  }
  return {s, [scene, changes](const RunState& state) {
            RunState seen = state;
            for_each_coordinate(scene, [&](int i, int k, int j) {
              if (!changes(scene.body[i], k)) return;
              flip(seen.q[j]);
              flip(seen.v[j]);
            });
            return seen;
          }};
}

Seen turned(const MechanismScene& scene) {
  MechanismScene s = scene;
  s.gravity = quarter(s.gravity);
  for (int i = 0; i < s.bodies; ++i) {
    Body& body = s.body[i];
    if (body.parent != ground) continue;
    body.at = quarter(body.at);
    body.turn = quarter(body.turn);
    body.angle = std::atan2(body.turn.y, body.turn.x);
    if (body.turn.x == 1) body.angle = 0;
  }
  for (int g = 0; g < s.guides; ++g) {
    Guide& guide = s.guide[g];
    if (guide.rail != ground) continue;
    for (Vec2* r : {&guide.origin, &guide.direction, &guide.tangent}) *r = quarter(*r);
  }
  for (int p = 0; p < s.pins; ++p) {
    if (s.pin[p].b == ground) s.pin[p].b_at = quarter(s.pin[p].b_at);
  }
  for (int k = 0; k < s.springs; ++k) {
    if (s.spring[k].b == ground) s.spring[k].b_at = quarter(s.spring[k].b_at);
  }
  for (int l = 0; l < s.loads; ++l) s.load[l].force = quarter(s.load[l].force);
  return {s, [](const RunState& state) { return state; }};
}

Seen with_guides_reversed(const MechanismScene& scene) {
  MechanismScene s = scene;
  for (int g = 0; g < s.guides; ++g) {
    for (Vec2* r : {&s.guide[g].direction, &s.guide[g].tangent}) *r = {-r->x, -r->y};
  }
  return {s, [](const RunState& state) {
            RunState seen = state;
            for (signed char& mode : seen.mode) mode = static_cast<signed char>(-mode);
            for (signed char& sign : seen.sign) sign = static_cast<signed char>(-sign);
            return seen;
          }};
}

Seen reordered(const MechanismScene& scene, const std::vector<int>& guides) {
  MechanismScene s = scene;
  // Bodies: by depth, last first within one depth.
  std::vector<int> depth, order;
  for (int i = 0; i < scene.bodies; ++i) {
    const int parent = scene.body[i].parent;
    depth.push_back(parent == ground ? 0 : depth[static_cast<std::size_t>(parent)] + 1);
    order.push_back(scene.bodies - 1 - i);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return depth[static_cast<std::size_t>(a)] < depth[static_cast<std::size_t>(b)];
  });
  std::vector<int> now(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) now[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  const auto moved = [&](int body) { return body == ground ? ground : now[static_cast<std::size_t>(body)]; };
  for (int i = 0; i < scene.bodies; ++i) {
    Body& body = s.body[moved(i)] = scene.body[i];
    body.parent = moved(body.parent);
  }
  std::vector<int> first;
  int count = 0;
  for (int i = 0; i < scene.bodies; ++i) {
    first.push_back(count);
    count += coordinates(s.body[i].joint);
  }
  std::vector<int> place;  // of coordinate j
  for_each_coordinate(scene,
                      [&](int i, int k, int) { place.push_back(first[static_cast<std::size_t>(moved(i))] + k); });
  for (std::size_t k = 0; k < guides.size(); ++k) {
    s.guide[k] = scene.guide[guides[k]];
    s.guide[k].slider = moved(s.guide[k].slider);
    s.guide[k].rail = moved(s.guide[k].rail);
  }
  for (int d = 0; d < s.drives; ++d) s.drive[d].body = moved(s.drive[d].body);
  for (int p = 0; p < s.pins; ++p) {
    s.pin[p].a = moved(s.pin[p].a);
    s.pin[p].b = moved(s.pin[p].b);
  }
  for (int k = 0; k < s.springs; ++k) {
    s.spring[k].a = moved(s.spring[k].a);
    s.spring[k].b = moved(s.spring[k].b);
  }
  for (int k = 0; k < s.joint_springs; ++k) s.joint_spring[k].body = moved(s.joint_spring[k].body);
  for (int l = 0; l < s.loads; ++l) s.load[l].body = moved(s.load[l].body);
  return {s, [place, guides](const RunState& state) {
            RunState seen = state;
            for (std::size_t j = 0; j < place.size(); ++j) {
              seen.q[place[j]] = state.q[j];
              seen.v[place[j]] = state.v[j];
            }
            for (std::size_t k = 0; k < guides.size(); ++k) seen.mode[k] = state.mode[guides[k]];
            return seen;
          }};
}

Seen in_units(const MechanismScene& scene, int length, int mass, int time) {
  // A quantity of dimension m^l kg^k s^t becomes that times this.
  const auto unit = [=](int l, int k, int t) { return std::ldexp(1.0, l * length + 2 * k * mass + t * time); };
  const double m = unit(1, 0, 0), newton = unit(1, 1, -2);
  const auto scale = [](Vec2& r, double by) { r = {by * r.x, by * r.y}; };
  MechanismScene s = scene;
  scale(s.gravity, unit(1, 0, -2));
  s.alpha *= unit(0, 0, -1);
  s.beta *= unit(0, 0, -2);
  for (int i = 0; i < s.bodies; ++i) {
    Body& body = s.body[i];
    scale(body.at, m);
    scale(body.com, m);
    body.mass *= unit(0, 1, 0);
    body.inertia *= unit(2, 1, 0);
    for (int k = 0; k < coordinates(body.joint); ++k) {
      body.q[k] *= turns(body, k) ? 1 : m;
      body.v[k] *= turns(body, k) ? unit(0, 0, -1) : unit(1, 0, -1);
    }
  }
  for (int g = 0; g < s.guides; ++g) {
    Guide& guide = s.guide[g];
    scale(guide.origin, m);
    scale(guide.contact[0], m);
    scale(guide.contact[1], m);
    guide.viscous *= unit(0, 1, -1);
    guide.preload *= newton;
  }
  for (int d = 0; d < s.drives; ++d) {
    Drive& drive = s.drive[d];
    const double size = turns(s.body[drive.body], drive.axis) ? 1 : m;
    if (drive.law == Law::harmonic) {
      drive.c[0] *= size;
      drive.c[1] *= size;
      drive.c[2] *= unit(0, 0, -1);
    } else {
      for (int k = 0; k < 8; ++k) drive.c[k] *= size * unit(0, 0, -k);
    }
  }
  for (int p = 0; p < s.pins; ++p) {
    scale(s.pin[p].a_at, m);
    scale(s.pin[p].b_at, m);
  }
  for (int k = 0; k < s.springs; ++k) {
    Spring& spring = s.spring[k];
    scale(spring.a_at, m);
    scale(spring.b_at, m);
    spring.length *= m;
    spring.stiffness *= unit(0, 1, -2);
    spring.damping *= unit(0, 1, -1);
  }
  for (int k = 0; k < s.joint_springs; ++k) {
    JointSpring& spring = s.joint_spring[k];
    const int l = turns(s.body[spring.body], 0) ? 2 : 0;
    spring.stiffness *= unit(l, 1, -2);
    spring.damping *= unit(l, 1, -1);
    if (l == 0) spring.rest *= m;
  }
  for (int l = 0; l < s.loads; ++l) {
    Load& load = s.load[l];
    scale(load.at, m);
    scale(load.force, newton);
    load.torque *= unit(2, 1, -2);
  }
  return {s,
          [scene, unit](const RunState& state) {
            RunState seen = state;
            for_each_coordinate(scene, [&](int i, int k, int j) {
              const int l = turns(scene.body[i], k) ? 0 : 1;
              seen.q[j] *= unit(l, 0, 0);
              seen.v[j] *= unit(l, 0, -1);
            });
            seen.start *= unit(0, 0, 1);
            seen.dt *= unit(0, 0, 1);
            return seen;
          },
          unit(0, 0, 1)};
}

Seen doubled(const MechanismScene& scene) {
  MechanismScene s = scene;
  const auto moved = [&](int body) { return body == ground ? ground : body + scene.bodies; };
  const auto append = [](auto* items, int& count, auto change) {
    const int once = count;
    for (int k = 0; k < once; ++k) change(items[count++] = items[k]);
  };
  const auto move_both = [&](auto& item) {
    item.a = moved(item.a);
    item.b = moved(item.b);
  };
  const auto move_one = [&](auto& item) { item.body = moved(item.body); };
  append(s.body, s.bodies, [&](Body& body) { body.parent = moved(body.parent); });
  append(s.guide, s.guides, [&](Guide& guide) {
    guide.slider = moved(guide.slider);
    guide.rail = moved(guide.rail);
  });
  append(s.drive, s.drives, move_one);
  append(s.pin, s.pins, move_both);
  append(s.spring, s.springs, move_both);
  append(s.joint_spring, s.joint_springs, move_one);
  append(s.load, s.loads, move_one);
  int n = 0;
  for_each_coordinate(scene, [&](int, int, int) { ++n; });
  return {s, [n, guides = scene.guides](const RunState& state) {
            RunState seen = state;
            for (int j = 0; j < n; ++j) {
              seen.q[n + j] = state.q[j];
              seen.v[n + j] = state.v[j];
            }
            for (int g = 0; g < guides; ++g) seen.mode[guides + g] = state.mode[g];
            return seen;
          }};
}

}  // namespace slideway::properties
