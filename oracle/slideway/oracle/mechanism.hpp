// A mechanism in Cartesian coordinates: three for every body (centre of mass x, y; angle theta), and a row for every
// constraint, recorded on a tape so that each is a series in time.
//
// Every row is one of two functions of the positions of two bodies A and B:
//   along   d . (r_A - o_B), the place of a point of A along a direction d that is fixed in B
//   angle   theta_A - theta_B
// Joints, guides, pins and drives are rows set to zero or to a law; a joint's coordinates are rows too, and so are the
// sliding speeds. With r the place of A's point, the rate of an `along` row is
//   d . (velocity of A's point - velocity of B's material point at r)
// because theta_B' perp(d) . (r - o_B) = -theta_B' d . perp(r - o_B): a force along d acts on both bodies at r.
#pragma once

#include <array>
#include <slideway/oracle/model.hpp>
#include <slideway/oracle/series.hpp>
#include <vector>

namespace slideway::oracle {

template <class T>
class Mechanism {
 public:
  using Node = typename Tape<T>::Node;

  struct Row {
    int a, b;                        ///< bodies; -1: the ground
    std::array<Node, 3> on_a, on_b;  ///< d value / d (x, y, theta)
    Node value, speed;               ///< and its rate
    Node turning;                    ///< what the second derivative is without accelerations
  };

  Mechanism(const Model<T>& data, int orders) : model(data), tape(orders) {
    for (std::size_t i = 0; i < model.body.size(); ++i) {
      frame_.push_back({tape.variable(), tape.variable(), tape.variable(), {}});
      frame_.back().turn = tape.turn(frame_.back().theta);
    }
    for (std::size_t i = 0; i < model.body.size(); ++i) add_joint(static_cast<int>(i));
    for (const auto& guide : model.guide) {
      for (const Vec<T>& contact : guide.contact) {
        const Vec<T> t = guide.direction, n = {T(-t.y), t.x};
        normal.push_back(along(guide.slider, contact, guide.rail, guide.origin, n));
        tangential.push_back(along(guide.slider, contact, guide.rail, guide.origin, t));
        guide_of.push_back(static_cast<int>(&guide - model.guide.data()));
      }
    }
    for (const auto& p : model.pin) {
      pin.push_back(along(p.a, p.a_at, p.b, p.b_at, {T(1), T(0)}));
      pin.push_back(along(p.a, p.a_at, p.b, p.b_at, {T(0), T(1)}));
    }
    for (std::size_t d = 0; d < model.drive.size(); ++d) law.push_back(tape.variable());
    add_forces();
  }

  const Model<T> model;
  Tape<T> tape;
  std::vector<Row> joint;               ///< zero, and kept so by every method
  std::vector<Row> coordinate;          ///< the joints' coordinates, body by body
  std::vector<int> first_coordinate;    ///< of each body
  std::vector<Row> normal, tangential;  ///< of each contact, guide by guide
  std::vector<int> guide_of;            ///< of each contact
  std::vector<Row> pin;                 ///< two a pin, along the axes of body b
  std::vector<Node> law;                ///< of each drive
  std::vector<Node> force;              ///< three a body: all but constraints and Coulomb friction
  Node load_power, damper_power;        ///< W
  Node potential;                       ///< of gravity and springs, J

  int bodies() const { return static_cast<int>(model.body.size()); }
  const Row& driven(int d) const {
    const auto& drive = model.drive[static_cast<std::size_t>(d)];
    return coordinate[static_cast<std::size_t>(first_coordinate[static_cast<std::size_t>(drive.body)] + drive.axis)];
  }
  T mass(int component) const {
    const auto& body = model.body[static_cast<std::size_t>(component / 3)];
    return component % 3 == 2 ? body.inertia : body.mass;
  }
  const Node& position(int component) const {
    const Frame& f = frame_[static_cast<std::size_t>(component / 3)];
    return component % 3 == 0 ? f.x : component % 3 == 1 ? f.y : f.theta;
  }
  /// cos and sin of a body's angle.
  const typename Tape<T>::Turn& turn(int body) const { return frame_[static_cast<std::size_t>(body)].turn; }

 private:
  struct Arrow {
    Node x, y;
    friend Arrow operator+(const Arrow& a, const Arrow& b) { return {a.x + b.x, a.y + b.y}; }
    friend Arrow operator-(const Arrow& a, const Arrow& b) { return {a.x - b.x, a.y - b.y}; }
    friend Node dot(const Arrow& a, const Arrow& b) { return a.x * b.x + a.y * b.y; }
    friend Node cross(const Arrow& a, const Arrow& b) { return a.x * b.y - a.y * b.x; }
  };
  struct Frame {
    Node x, y, theta;
    typename Tape<T>::Turn turn;
  };

  Arrow turned(int body, const Vec<T>& r) const {
    if (body == ground) return {r.x, r.y};
    const auto& u = turn(body);
    return {r.x * u.cosine - r.y * u.sine, r.x * u.sine + r.y * u.cosine};
  }
  Arrow centre(int body) const { return body == ground ? Arrow{} : Arrow{position(3 * body), position(3 * body + 1)}; }
  /// From the centre of mass to the point `at` of the body's frame.
  Arrow arm(int body, const Vec<T>& at) const {
    if (body == ground) return {at.x, at.y};
    const Vec<T>& com = model.body[static_cast<std::size_t>(body)].com;
    return turned(body, {T(at.x - com.x), T(at.y - com.y)});
  }
  Node theta(int body) const { return body == ground ? Node() : position(3 * body + 2); }

  Row along(int a, const Vec<T>& at, int b, const Vec<T>& origin, const Vec<T>& direction) {
    const Arrow d = turned(b, direction), on_a = arm(a, at);
    const Arrow on_b = centre(a) + on_a - centre(b);
    return finish(
        {a, b, {d.x, d.y, cross(on_a, d)}, {-d.x, -d.y, -cross(on_b, d)}, dot(d, on_b - arm(b, origin)), {}, {}});
  }
  Row angle(int a, int b, const T& offset) {
    return finish({a,
                   b,
                   {Node(), Node(), Node(T(1))},
                   {Node(), Node(), Node(T(-1))},
                   theta(a) - theta(b) - Node(offset),
                   {},
                   {}});
  }
  Row finish(Row row) {
    const auto add = [&](int body, const std::array<Node, 3>& entry) {
      if (body == ground) return;
      for (int j = 0; j < 3; ++j) {
        const Node velocity = rate(position(3 * body + j));
        row.speed = row.speed + entry[static_cast<std::size_t>(j)] * velocity;
        row.turning = row.turning + rate(entry[static_cast<std::size_t>(j)]) * velocity;
      }
    };
    add(row.a, row.on_a);
    add(row.b, row.on_b);
    return row;
  }

  void add_joint(int i) {
    const auto& body = model.body[static_cast<std::size_t>(i)];
    const Vec<T> zero = {T(0), T(0)}, t = body.turn, n = {T(-t.y), t.x};
    const auto place = [&](const Vec<T>& direction) { return along(i, zero, body.parent, body.at, direction); };
    const Row turning = angle(i, body.parent, body.angle);
    first_coordinate.push_back(static_cast<int>(coordinate.size()));
    switch (body.joint) {
      case Joint::revolute:
        coordinate.push_back(turning);
        joint.insert(joint.end(), {place(t), place(n)});
        break;
      case Joint::prismatic:
        coordinate.push_back(place(t));
        joint.insert(joint.end(), {place(n), turning});
        break;
      case Joint::planar:
        coordinate.insert(coordinate.end(), {place(t), place(n), turning});
        break;
      case Joint::fixed:
        joint.insert(joint.end(), {place(t), place(n), turning});
        break;
    }
  }

  Node& force_on(int body, int j) { return force[static_cast<std::size_t>(3 * body + j)]; }

  /// f at the point `at` of a body, f in the world's frame.
  void apply(int body, const Vec<T>& at, const Arrow& f) {
    if (body == ground) return;
    force_on(body, 0) = force_on(body, 0) + f.x;
    force_on(body, 1) = force_on(body, 1) + f.y;
    force_on(body, 2) = force_on(body, 2) + cross(arm(body, at), f);
  }

  /// The force f along a row.
  void act(const Row& row, const Node& f) {
    for (int j = 0; j < 3; ++j) {
      const auto k = static_cast<std::size_t>(j);
      if (row.a != ground) force_on(row.a, j) = force_on(row.a, j) + f * row.on_a[k];
      if (row.b != ground) force_on(row.b, j) = force_on(row.b, j) + f * row.on_b[k];
    }
  }

  void add_forces() {
    for (int i = 0; i < bodies(); ++i) {
      const Node fx(T(mass(3 * i) * model.gravity.x)), fy(T(mass(3 * i) * model.gravity.y));
      force.insert(force.end(), {fx, fy, Node()});
      potential = potential - fx * position(3 * i) - fy * position(3 * i + 1);
    }
    const T half = T(1) / 2;
    for (const auto& load : model.load) {
      apply(load.body, load.at, {load.force.x, load.force.y});
      force_on(load.body, 2) = force_on(load.body, 2) + Node(load.torque);
      const Arrow place = centre(load.body) + arm(load.body, load.at);
      load_power = load_power + load.force.x * rate(place.x) + load.force.y * rate(place.y) +
                   load.torque * rate(theta(load.body));
    }
    for (const auto& s : model.spring) {
      const Arrow gap = centre(s.a) + arm(s.a, s.a_at) - centre(s.b) - arm(s.b, s.b_at);
      const Node length = root(dot(gap, gap)), stretching = rate(length), stretch = length - Node(s.length);
      const Node pull = (s.stiffness * stretch + s.damping * stretching) * reciprocal(length);
      apply(s.a, s.a_at, {-(pull * gap.x), -(pull * gap.y)});
      apply(s.b, s.b_at, {pull * gap.x, pull * gap.y});
      potential = potential + half * s.stiffness * (stretch * stretch);
      damper_power = damper_power + s.damping * (stretching * stretching);
    }
    for (const auto& s : model.joint_spring) {
      const Row& row = coordinate[static_cast<std::size_t>(first_coordinate[static_cast<std::size_t>(s.body)])];
      const Node stretch = row.value - Node(s.rest);
      act(row, -(s.stiffness * stretch + s.damping * row.speed));
      potential = potential + half * s.stiffness * (stretch * stretch);
      damper_power = damper_power + s.damping * (row.speed * row.speed);
    }
    for (std::size_t c = 0; c < guide_of.size(); ++c) {  // viscous friction, at the guide's first contact
      const auto& guide = model.guide[static_cast<std::size_t>(guide_of[c])];
      if (guide.viscous == 0 || (c > 0 && guide_of[c - 1] == guide_of[c])) continue;
      act(tangential[c], -(guide.viscous * tangential[c].speed));
    }
  }

  std::vector<Frame> frame_;
};

}  // namespace slideway::oracle
