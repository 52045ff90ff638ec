// scene.hpp's definitions of frames, rows and potentials, each with its first two derivatives along a motion: nothing
// of the oracle's own formulas.
#pragma once

#include <support/oracle.hpp>

namespace slideway::test {

/// A value and its first two derivatives along the motion.
struct Jet {
  Real f, d, dd;
  Jet(const Real& value, const Real& first = Real(0), const Real& second = Real(0)) : f(value), d(first), dd(second) {}
  friend Jet operator+(const Jet& a, const Jet& b) { return {a.f + b.f, a.d + b.d, a.dd + b.dd}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.f - b.f, a.d - b.d, a.dd - b.dd}; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + 2 * a.d * b.d + a.f * b.dd};
  }
};
inline Jet chain(const Jet& x, const Real& f, const Real& first, const Real& second) {
  return {f, first * x.d, second * x.d * x.d + first * x.dd};
}
inline Jet sine(const Jet& x) { return chain(x, sin(x.f), cos(x.f), -sin(x.f)); }
inline Jet cosine(const Jet& x) { return chain(x, cos(x.f), -sin(x.f), -cos(x.f)); }
inline Jet root(const Jet& x) { return chain(x, sqrt(x.f), 1 / (2 * sqrt(x.f)), -1 / (4 * x.f * sqrt(x.f))); }

struct Point {
  Jet x, y;
  friend Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
};
inline Jet dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y; }
inline Point rotated(const Point& r, const Jet& by) {
  return {cosine(by) * r.x - sine(by) * r.y, sine(by) * r.x + cosine(by) * r.y};
}
inline Point point(const RealVec& r) { return {r.x, r.y}; }

/// A body's frame: origin at its joint, angle against the world.
struct Frame {
  Point origin;
  Jet angle;
  Point place(const RealVec& at) const { return origin + rotated(point(at), angle); }
  Point direction(const RealVec& d) const { return rotated(point(d), angle); }
};
inline const Frame world{{Real(0), Real(0)}, Real(0)};

using Frames = std::vector<Frame>;
inline const Frame& frame_of(const Frames& frames, int body) {
  return body == ground ? world : frames[static_cast<std::size_t>(body)];
}

/// The frames at position + velocity tau: centre of mass = origin + R com.
inline Frames frames_along(const RealModel& model, const std::vector<Real>& position,
                           const std::vector<Real>& velocity) {
  Frames frames;
  for (std::size_t i = 0; i < model.body.size(); ++i) {
    const auto jet = [&](std::size_t j) { return Jet(position[3 * i + j], velocity[3 * i + j]); };
    const Jet angle = jet(2);
    frames.push_back({Point{jet(0), jet(1)} - rotated(point(model.body[i].com), angle), angle});
  }
  return frames;
}

/// All rows, in the order of Mechanism's joint, coordinate, normal, tangential, pin.
struct Values {
  std::vector<Jet> joint, coordinate, normal, tangential, pin;
};

inline void add_joint(const RealModel::Body& body, const Frame& frame, const Frame& parent, Values& all) {
  const Jet turned = frame.angle - parent.angle - Jet(body.angle);
  const Point moved = rotated(frame.origin - parent.place(body.at), Jet(Real(0)) - parent.angle - Jet(body.angle));
  const auto joint = [&](const Jet& row) { all.joint.push_back(row); };
  const auto coordinate = [&](const Jet& row) { all.coordinate.push_back(row); };
  const bool turns = body.joint == Joint::revolute || body.joint == Joint::planar;
  const bool slides = body.joint == Joint::prismatic || body.joint == Joint::planar;
  slides ? coordinate(moved.x) : joint(moved.x);
  body.joint == Joint::planar ? coordinate(moved.y) : joint(moved.y);
  turns ? coordinate(turned) : joint(turned);
}

inline Values values(const RealModel& model, const Frames& frames) {
  Values all;
  for (std::size_t i = 0; i < model.body.size(); ++i) {
    add_joint(model.body[i], frames[i], frame_of(frames, model.body[i].parent), all);
  }
  for (const auto& guide : model.guide) {
    const Frame &rail = frame_of(frames, guide.rail), &slider = frame_of(frames, guide.slider);
    const Point along = rail.direction(guide.direction);
    for (const RealVec& contact : guide.contact) {
      const Point off = slider.place(contact) - rail.place(guide.origin);
      all.tangential.push_back(dot(along, off));
      all.normal.push_back(along.x * off.y - along.y * off.x);  // n = direction turned +90 degrees
    }
  }
  for (const auto& pin : model.pin) {
    const Frame& b = frame_of(frames, pin.b);
    const Point gap = rotated(frame_of(frames, pin.a).place(pin.a_at) - b.place(pin.b_at), Jet(Real(0)) - b.angle);
    all.pin.insert(all.pin.end(), {gap.x, gap.y});
  }
  return all;
}

/// Poses of the joints' coordinates q + v tau, by the frames' definition in scene.hpp.
inline Frames frames_of_joints(const RealModel& model) {
  Frames frames;
  std::size_t j = 0;
  for (const auto& body : model.body) {
    const auto coordinate = [&] {
      const Jet q(model.start.q[j], model.start.v[j]);
      ++j;
      return q;
    };
    const Frame& parent = frame_of(frames, body.parent);
    Frame frame{parent.place(body.at), parent.angle + Jet(body.angle)};
    if (body.joint == Joint::prismatic) frame.origin = frame.origin + rotated({coordinate(), Real(0)}, frame.angle);
    if (body.joint == Joint::planar) {
      const Jet x = coordinate(), y = coordinate();
      frame.origin = frame.origin + rotated({x, y}, frame.angle);
    }
    if (body.joint == Joint::revolute || body.joint == Joint::planar) frame.angle = frame.angle + coordinate();
    frames.push_back(frame);
  }
  return frames;
}

/// Gravity, springs and constant loads.
inline Jet potential(const RealModel& model, const Frames& frames) {
  Jet sum(Real(0));
  const Values all = values(model, frames);
  for (std::size_t i = 0; i < model.body.size(); ++i) {
    const auto& body = model.body[i];
    sum = sum - Jet(body.mass) * dot(point(model.gravity), frames[i].place(body.com));
  }
  for (const auto& s : model.spring) {
    const Point gap = frame_of(frames, s.a).place(s.a_at) - frame_of(frames, s.b).place(s.b_at);
    const Jet stretch = root(dot(gap, gap)) - Jet(s.length);
    sum = sum + Jet(s.stiffness / 2) * stretch * stretch;
  }
  for (const auto& s : model.joint_spring) {
    std::size_t coordinate = 0;
    for (int i = 0; i < s.body; ++i) {
      coordinate += static_cast<std::size_t>(slideway::coordinates(model.body[static_cast<std::size_t>(i)].joint));
    }
    const Jet stretch = all.coordinate[coordinate] - Jet(s.rest);
    sum = sum + Jet(s.stiffness / 2) * stretch * stretch;
  }
  for (const auto& l : model.load) {
    const Frame& frame = frame_of(frames, l.body);
    sum = sum - dot(point(l.force), frame.place(l.at)) - Jet(l.torque) * frame.angle;
  }
  return sum;
}

}  // namespace slideway::test
