// Equations of motion as a user of a general integrator writes them: x, y and angle of every body, one row for each
// constraint, and one dense system for accelerations and constraint forces, by Eigen (Haug, Computer Aided Kinematics
// and Dynamics of Mechanical Systems, 1989). Baumgarte's terms hold the constraints.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "equations.hpp"

namespace slideway::charts {

/// Friction of a guide in one evaluation.
struct GuideFriction {
  double per_force = 0;  ///< F of each N of contact force, along the guide: -mu sgn(v), or regularised
  bool held = false;     ///< at rest: F is an unknown, and v' = -alpha v a row
};

class CartesianEquations {
 public:
  explicit CartesianEquations(const RunScene& scene);

  int bodies() const { return scene_.bodies; }
  /// Places x (x, y of the origin and angle, body by body) and their rates u from joint coordinates, and back.
  void from_joints(const double* q, const double* v, double* x, double* u) const;
  void to_joints(const double* x, const double* u, double* q, double* v) const;

  /// Sliding speed of a guide.
  double slip(int guide, const double* x, const double* u) const;

  /// Accelerations. `sign`, of the contact forces: kept if `follow`, else a first guess that is changed until the
  /// forces have it. False where none is found.
  bool accelerate(double t, const double* x, const double* u, const GuideFriction* friction, signed char* sign,
                  bool follow, double* acceleration);
  // Of the last accelerate():
  double lambda(int contact) const { return forces()[row_of_contact(contact)]; }
  /// One for each row: of joints and pins, of drives, of contacts, of guides held.
  const double* forces() const { return solution_.data() + 3 * scene_.bodies; }

  /// The same equations as an implicit solver asks for them, all at once: what given accelerations and forces leave of
  /// the laws of motion (3 for each body) and of each row. `sign` is of the contact forces.
  void residual(double t, const double* x, const double* u, const GuideFriction* friction, const signed char* sign,
                const double* acceleration, const double* force, double* left);
  // Of the last residual() or accelerate():
  int rows() const { return row_ - 3 * scene_.bodies; }
  int row_of_contact(int contact) const { return first_contact_ - 3 * scene_.bodies + contact; }
  int row_of_held(int guide) const { return held_[guide] - 3 * scene_.bodies; }
  double Phi(int row) const { return Phi_(3 * scene_.bodies + row); }
  double Phi_rate(int row) const { return rate_(3 * scene_.bodies + row); }
  /// out += Phi_q^T m.
  void add_transposed(const double* m, double* out) const;
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  const Eigen::VectorXd& right() const { return right_; }

 private:
  struct Point;
  struct JointFrame;
  JointFrame joint_frame(int body, const double* x, const double* u) const;
  Point point(int body, Vec2 at, const double* x, const double* u) const;
  void constrain(const Point& a, const Point& b, Vec2 direction, bool turns, double Phi_target, double rate_target,
                 double target, bool position);
  void constrain_angle(int a, int b, double Phi, double rate, double target);
  void push(int column, const Point& a, const Point& b, Vec2 force);
  void apply(const Point& p, Vec2 force);
  void joints(double t, const double* x, const double* u);
  void drives(double t, const double* x, const double* u);
  void guides(const double* x, const double* u, const GuideFriction* friction, const signed char* sign);
  void forces(double t, const double* x, const double* u, const GuideFriction* friction);
  void assemble(double t, const double* x, const double* u, const GuideFriction* friction, const signed char* sign);

  const RunScene& scene_;
  int row_ = 0, first_contact_ = 0;
  int held_[Size::guides] = {};
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_, solution_, Phi_, rate_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace slideway::charts
