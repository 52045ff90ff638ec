#include "cartesian.hpp"

#include <cmath>

namespace slideway::charts {

/// A point of a body (or of the ground), its velocity, and what its acceleration is without the body's.
struct CartesianEquations::Point {
  int body;
  Vec2 from_origin, place, velocity, acceleration;
  double rate;
};

/// A body's joint on its parent: its point of the parent, the parent's angle, the direction of its first axis.
struct CartesianEquations::JointFrame {
  Point base;
  double parent_angle;
  Vec2 along;
};

namespace {

Rotation turn_of(int body, const double* x) {
  return body == ground ? Rotation{1, 0} : Rotation{std::cos(x[3 * body + 2]), std::sin(x[3 * body + 2])};
}

Vec2 normal_of(Vec2 tangent) { return perp(tangent); }

}  // namespace

CartesianEquations::CartesianEquations(const RunScene& scene) : scene_(scene) {}

CartesianEquations::Point CartesianEquations::point(int body, Vec2 at, const double* x, const double* u) const {
  if (body == ground) return {ground, at, at, {}, {}, 0};
  const Vec2 arm = turn_of(body, x) * at;
  const double rate = u[3 * body + 2];
  return {body,
          arm,
          Vec2{x[3 * body], x[3 * body + 1]} + arm,
          Vec2{u[3 * body], u[3 * body + 1]} + rate * perp(arm),
          -(rate * rate) * arm,
          rate};
}

CartesianEquations::JointFrame CartesianEquations::joint_frame(int i, const double* x, const double* u) const {
  const Body& body = scene_.body[i];
  const Rotation frame = turn_of(body.parent, x) * Rotation{body.turn.x, body.turn.y};
  return {point(body.parent, body.at, x, u), body.parent == ground ? 0 : x[3 * body.parent + 2], {frame.c, frame.s}};
}

void CartesianEquations::from_joints(const double* q, const double* v, double* x, double* u) const {
  for (int i = 0, j = 0; i < scene_.bodies; ++i) {
    const Body& body = scene_.body[i];
    const auto [base, parent_angle, along] = joint_frame(i, x, u);
    double *place = x + 3 * i, *rate = u + 3 * i;
    Vec2 slide{}, slide_rate{};
    place[2] = parent_angle + body.angle;
    rate[2] = base.rate;
    if (body.joint == Joint::prismatic || body.joint == Joint::planar) {
      slide = q[j] * along;
      slide_rate = v[j] * along;
    }
    if (body.joint == Joint::planar) {
      slide = slide + q[j + 1] * perp(along);
      slide_rate = slide_rate + v[j + 1] * perp(along);
    }
    if (body.joint == Joint::revolute || body.joint == Joint::planar) {
      place[2] += q[body.joint == Joint::planar ? j + 2 : j];
      rate[2] += v[body.joint == Joint::planar ? j + 2 : j];
    }
    const Vec2 origin = base.place + slide, velocity = base.velocity + slide_rate + base.rate * perp(slide);
    place[0] = origin.x;
    place[1] = origin.y;
    rate[0] = velocity.x;
    rate[1] = velocity.y;
    j += coordinates(body.joint);
  }
}

void CartesianEquations::to_joints(const double* x, const double* u, double* q, double* v) const {
  for (int i = 0, j = 0; i < scene_.bodies; ++i) {
    const Body& body = scene_.body[i];
    const auto [base, parent_angle, along] = joint_frame(i, x, u);
    const Vec2 slide = Vec2{x[3 * i], x[3 * i + 1]} - base.place;
    const Vec2 slide_rate = Vec2{u[3 * i], u[3 * i + 1]} - base.velocity - base.rate * perp(slide);
    if (body.joint == Joint::prismatic || body.joint == Joint::planar) {
      q[j] = dot(slide, along);
      v[j] = dot(slide_rate, along);
    }
    if (body.joint == Joint::planar) {
      q[j + 1] = dot(slide, perp(along));
      v[j + 1] = dot(slide_rate, perp(along));
    }
    if (body.joint == Joint::revolute || body.joint == Joint::planar) {
      const int turning = body.joint == Joint::planar ? j + 2 : j;
      q[turning] = x[3 * i + 2] - parent_angle - body.angle;
      v[turning] = u[3 * i + 2] - base.rate;
    }
    j += coordinates(body.joint);
  }
}

double CartesianEquations::slip(int g, const double* x, const double* u) const {
  const Guide& guide = scene_.guide[g];
  const Point a = point(guide.slider, guide.contact[0], x, u), b = point(guide.rail, guide.origin, x, u);
  const Vec2 t = turn_of(guide.rail, x) * guide.tangent;
  return dot(t, a.velocity - b.velocity - b.rate * perp(a.place - b.place));
}

/// A row for direction . (a - b) = target; the direction turns with b's body, or does not.
void CartesianEquations::constrain(const Point& a, const Point& b, Vec2 e, bool turns, double Phi_target,
                                   double rate_target, double target, bool position) {
  const Vec2 gap = a.place - b.place;
  const double spin = turns ? b.rate : 0;
  const double Phi = position ? dot(e, gap) - Phi_target : 0;
  const double rate = dot(e, a.velocity - b.velocity) + spin * dot(perp(e), gap) - rate_target;
  const double known = dot(e, a.acceleration - b.acceleration) + 2 * spin * dot(perp(e), a.velocity - b.velocity) -
                       spin * spin * dot(e, gap);
  if (a.body != ground) {
    matrix_(row_, 3 * a.body) += e.x;
    matrix_(row_, 3 * a.body + 1) += e.y;
    matrix_(row_, 3 * a.body + 2) += dot(e, perp(a.from_origin));
  }
  if (b.body != ground) {
    matrix_(row_, 3 * b.body) -= e.x;
    matrix_(row_, 3 * b.body + 1) -= e.y;
    matrix_(row_, 3 * b.body + 2) -= dot(e, perp(turns ? b.from_origin + gap : b.from_origin));
  }
  right_(row_) = target - known - scene_.alpha * rate - scene_.beta * Phi;
  Phi_(row_) = Phi;
  rate_(row_) = rate;
}

void CartesianEquations::constrain_angle(int a, int b, double Phi, double rate, double target) {
  matrix_(row_, 3 * a + 2) += 1;
  if (b != ground) matrix_(row_, 3 * b + 2) -= 1;
  right_(row_) = target - scene_.alpha * rate - scene_.beta * Phi;
  Phi_(row_) = Phi;
  rate_(row_) = rate;
}

/// What an unknown in `column` does: a force on a's body at a's place, and the opposite on b's there.
void CartesianEquations::push(int column, const Point& a, const Point& b, Vec2 force) {
  if (a.body != ground) {
    matrix_(3 * a.body, column) -= force.x;
    matrix_(3 * a.body + 1, column) -= force.y;
    matrix_(3 * a.body + 2, column) -= cross(a.from_origin, force);
  }
  if (b.body != ground) {
    matrix_(3 * b.body, column) += force.x;
    matrix_(3 * b.body + 1, column) += force.y;
    matrix_(3 * b.body + 2, column) += cross(b.from_origin + (a.place - b.place), force);
  }
}

void CartesianEquations::apply(const Point& p, Vec2 force) {
  if (p.body == ground) return;
  right_(3 * p.body) += force.x;
  right_(3 * p.body + 1) += force.y;
  right_(3 * p.body + 2) += cross(p.from_origin, force);
}

void CartesianEquations::joints(double, const double* x, const double* u) {
  const auto coincide = [&](const Point& a, const Point& b) {
    for (const Vec2 e : {Vec2{1, 0}, Vec2{0, 1}}) {
      constrain(a, b, e, false, 0, 0, 0, true);
      push(row_++, a, b, e);
    }
  };
  for (int i = 0; i < scene_.bodies; ++i) {
    const Body& body = scene_.body[i];
    const Point a = point(i, {}, x, u), b = point(body.parent, body.at, x, u);
    if (body.joint == Joint::planar) continue;
    if (body.joint == Joint::prismatic) {
      const Rotation frame = turn_of(body.parent, x) * Rotation{body.turn.x, body.turn.y};
      const Vec2 n{-frame.s, frame.c};
      constrain(a, b, n, true, 0, 0, 0, true);
      push(row_++, a, b, n);
    } else {
      coincide(a, b);
    }
    if (body.joint == Joint::revolute) continue;
    const double parent_angle = body.parent == ground ? 0 : x[3 * body.parent + 2];
    constrain_angle(i, body.parent, x[3 * i + 2] - parent_angle - body.angle, a.rate - b.rate, 0);
    matrix_(3 * i + 2, row_) -= 1;
    if (body.parent != ground) matrix_(3 * body.parent + 2, row_) += 1;
    ++row_;
  }
  for (int p = 0; p < scene_.pins; ++p) {
    const Pin& pin = scene_.pin[p];
    coincide(point(pin.a, pin.a_at, x, u), point(pin.b, pin.b_at, x, u));
  }
}

void CartesianEquations::drives(double t, const double* x, const double* u) {
  for (int d = 0; d < scene_.drives; ++d) {
    const Drive& drive = scene_.drive[d];
    const Body& body = scene_.body[drive.body];
    const LawValue law = law_at(drive, t, nullptr, 0);
    const Point a = point(drive.body, {}, x, u), b = point(body.parent, body.at, x, u);
    const bool angle = body.joint == Joint::revolute || drive.axis == 2;
    if (angle) {
      const double parent_angle = body.parent == ground ? 0 : x[3 * body.parent + 2];
      constrain_angle(drive.body, body.parent, x[3 * drive.body + 2] - parent_angle - body.angle - law.value,
                      a.rate - b.rate - law.rate, law.acceleration);
      matrix_(3 * drive.body + 2, row_) -= 1;
      if (body.parent != ground) matrix_(3 * body.parent + 2, row_) += 1;
    } else {
      const Rotation frame = turn_of(body.parent, x) * Rotation{body.turn.x, body.turn.y};
      const Vec2 along{frame.c, frame.s}, e = drive.axis == 1 ? perp(along) : along;
      constrain(a, b, e, true, law.value, law.rate, law.acceleration, true);
      push(row_, a, b, e);
    }
    ++row_;
  }
}

void CartesianEquations::guides(const double* x, const double* u, const GuideFriction* friction,
                                const signed char* sign) {
  first_contact_ = row_;
  for (int g = 0, c = 0; g < scene_.guides; ++g) {
    const Guide& guide = scene_.guide[g];
    const Vec2 tangent = turn_of(guide.rail, x) * guide.tangent, n = normal_of(tangent);
    const Point b = point(guide.rail, guide.origin, x, u);
    for (int k = 0; k < guide.contacts; ++k, ++c) {
      const Point a = point(guide.slider, guide.contact[k], x, u);
      constrain(a, b, n, true, 0, 0, 0, true);
      push(row_++, a, b, n + (friction[g].per_force * (sign[c] < 0 ? -1 : 1)) * tangent);
    }
  }
  for (int g = 0; g < scene_.guides; ++g) {
    if (!friction[g].held) continue;
    const Guide& guide = scene_.guide[g];
    const Vec2 tangent = turn_of(guide.rail, x) * guide.tangent;
    const Point a = point(guide.slider, guide.contact[0], x, u), b = point(guide.rail, guide.origin, x, u);
    constrain(a, b, tangent, true, 0, 0, 0, false);
    push(row_, a, b, tangent);
    held_[g] = row_++;
  }
}

void CartesianEquations::forces(double, const double* x, const double* u, const GuideFriction* friction) {
  for (int i = 0; i < scene_.bodies; ++i) {
    const Body& body = scene_.body[i];
    const Vec2 com = turn_of(i, x) * body.com;
    const double rate = u[3 * i + 2];
    matrix_(3 * i, 3 * i) = matrix_(3 * i + 1, 3 * i + 1) = body.mass;
    matrix_(3 * i + 2, 3 * i + 2) = body.inertia + body.mass * dot(com, com);
    matrix_(3 * i, 3 * i + 2) = matrix_(3 * i + 2, 3 * i) = -body.mass * com.y;
    matrix_(3 * i + 1, 3 * i + 2) = matrix_(3 * i + 2, 3 * i + 1) = body.mass * com.x;
    const Vec2 weight = body.mass * scene_.gravity, spin = (body.mass * rate * rate) * com;
    right_(3 * i) = weight.x + spin.x;
    right_(3 * i + 1) = weight.y + spin.y;
    right_(3 * i + 2) = cross(com, weight);
  }
  for (int s = 0; s < scene_.springs; ++s) {
    const Spring& spring = scene_.spring[s];
    const Point a = point(spring.a, spring.a_at, x, u), b = point(spring.b, spring.b_at, x, u);
    const Vec2 gap = a.place - b.place;
    const double length = std::sqrt(dot(gap, gap));
    const Vec2 along = length > 0 ? (1 / length) * gap : Vec2{};
    const double force =
        -spring.stiffness * (length - spring.length) - spring.damping * dot(along, a.velocity - b.velocity);
    apply(a, force * along);
    apply(b, -force * along);
  }
  double q[Size::coordinates], v[Size::coordinates];
  if (scene_.joint_springs > 0) to_joints(x, u, q, v);
  for (int s = 0; s < scene_.joint_springs; ++s) {
    const JointSpring& spring = scene_.joint_spring[s];
    const Body& body = scene_.body[spring.body];
    int j = 0;
    for (int i = 0; i < spring.body; ++i) j += coordinates(scene_.body[i].joint);
    const double force = -spring.stiffness * (q[j] - spring.rest) - spring.damping * v[j];
    if (body.joint == Joint::revolute) {
      right_(3 * spring.body + 2) += force;
      if (body.parent != ground) right_(3 * body.parent + 2) -= force;
    } else {
      const Rotation frame = turn_of(body.parent, x) * Rotation{body.turn.x, body.turn.y};
      const Point a = point(spring.body, {}, x, u);
      Point b = point(body.parent, body.at, x, u);
      b.from_origin = b.from_origin + (a.place - b.place);
      apply(a, force * Vec2{frame.c, frame.s});
      apply(b, -force * Vec2{frame.c, frame.s});
    }
  }
  for (int l = 0; l < scene_.loads; ++l) {
    const Load& load = scene_.load[l];
    apply(point(load.body, load.at, x, u), load.force);
    right_(3 * load.body + 2) += load.torque;
  }
  for (int g = 0; g < scene_.guides; ++g) {
    const Guide& guide = scene_.guide[g];
    if (friction[g].held || (guide.viscous == 0 && guide.preload == 0)) continue;
    const double speed = slip(g, x, u);
    const double unit = guide.mu > 0 ? -friction[g].per_force / guide.mu : speed < 0 ? -1 : 1;  // sgn, or regularised
    const Vec2 force = (-guide.viscous * speed - guide.preload * unit) * (turn_of(guide.rail, x) * guide.tangent);
    const Point a = point(guide.slider, guide.contact[0], x, u);
    Point b = point(guide.rail, guide.origin, x, u);
    b.from_origin = b.from_origin + (a.place - b.place);
    apply(a, force);
    apply(b, -1 * force);
  }
}

void CartesianEquations::assemble(double t, const double* x, const double* u, const GuideFriction* friction,
                                  const signed char* sign) {
  int size = 3 * scene_.bodies + 2 * scene_.pins + scene_.drives;
  for (int i = 0; i < scene_.bodies; ++i) size += 3 - coordinates(scene_.body[i].joint);
  for (int g = 0; g < scene_.guides; ++g) size += scene_.guide[g].contacts + (friction[g].held ? 1 : 0);
  matrix_.setZero(size, size);
  right_.setZero(size);
  Phi_.resize(size);
  rate_.resize(size);
  row_ = 3 * scene_.bodies;
  forces(t, x, u, friction);
  joints(t, x, u);
  drives(t, x, u);
  guides(x, u, friction, sign);
}

bool CartesianEquations::accelerate(double t, const double* x, const double* u, const GuideFriction* friction,
                                    signed char* sign, bool follow, double* acceleration) {
  const int contacts_of_all = contacts(scene_);
  for (int round = 0; round < 8; ++round) {
    assemble(t, x, u, friction, sign);
    lu_.compute(matrix_);
    solution_ = lu_.solve(right_);
    bool same = true;
    for (int c = 0; c < contacts_of_all && !follow; ++c) {
      const signed char now = lambda(c) < 0 ? -1 : 1;
      same = same && now == (sign[c] < 0 ? -1 : 1);
      sign[c] = now;
    }
    if (!std::isfinite(solution_.sum())) return false;
    if (!same) continue;
    for (int i = 0; i < 3 * scene_.bodies; ++i) acceleration[i] = solution_(i);
    return true;
  }
  return false;
}

void CartesianEquations::residual(double t, const double* x, const double* u, const GuideFriction* friction,
                                  const signed char* sign, const double* acceleration, const double* force,
                                  double* left) {
  assemble(t, x, u, friction, sign);
  using Eigen::Map, Eigen::VectorXd;
  const int n = 3 * scene_.bodies;
  Map<VectorXd>(left, row_).noalias() = matrix_.leftCols(n) * Map<const VectorXd>(acceleration, n) - right_;
  Map<VectorXd>(left, n).noalias() += matrix_.topRightCorner(n, rows()) * Map<const VectorXd>(force, rows());
}

void CartesianEquations::add_transposed(const double* m, double* out) const {
  using Eigen::Map, Eigen::VectorXd;
  const int n = 3 * scene_.bodies;
  Map<VectorXd>(out, n).noalias() += matrix_.bottomLeftCorner(rows(), n).transpose() * Map<const VectorXd>(m, rows());
}

}  // namespace slideway::charts
