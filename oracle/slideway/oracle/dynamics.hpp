// Accelerations and forces of a mechanism in one mode, as series in time, from the full KKT system in Cartesian
// coordinates:
//
//   M a - J' lambda - (friction) = h       one row a body coordinate
//   J a = -J. v - alpha Phi. - beta Phi    one row a constraint; joints without the gains
//
// A mode fixes, for every rough guide, slip +1 or -1 or rest 0, and for each of its contacts the sign of the contact
// force. Then Coulomb's law is linear: a sliding guide's contact k has the friction force -slip c sign_k lambda_k, and
// a guide at rest has an unknown friction force and the row v' = -alpha v, which is v' = 0 where it rests, and takes
// from it what a step has left of its speed. Whether the mode is one that the law allows is for friction.hpp to say.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <slideway/oracle/elimination.hpp>
#include <slideway/oracle/mechanism.hpp>
#include <vector>

namespace slideway::oracle {

/// Positions and speeds of all bodies at one time: centre of mass x, y and angle, body by body.
template <class T>
struct Motion {
  T t;
  std::vector<T> position, velocity;
};

struct Mode {
  std::vector<int> slip;  ///< of each guide: +1, -1; 0 at rest, and for a guide without friction
  std::vector<int> sign;  ///< of each contact: +1, -1
  friend bool operator==(const Mode&, const Mode&) = default;
};

/// Coefficients of friction, one a guide: which of mu and mu_static acts is friction.hpp's choice.
template <class T>
using Coefficients = std::vector<T>;

template <class T>
class Dynamics {
 public:
  using Vector = std::vector<T>;
  using Node = typename Tape<T>::Node;
  using Row = typename Mechanism<T>::Row;

  /// Series with coefficients of positions 0 .. orders - 1, of forces 0 .. orders - 3.
  Dynamics(const Model<T>& model, int orders) : mechanism(model, orders) {
    const auto add = [&](const Row& row, const T& alpha, const T& beta, int drive) {
      constraints_.push_back({&row, alpha, beta, drive});
    };
    for (const Row& row : mechanism.joint) add(row, T(0), T(0), none);
    for (std::size_t d = 0; d < model.drive.size(); ++d) {
      add(mechanism.driven(static_cast<int>(d)), model.alpha, model.beta, static_cast<int>(d));
    }
    for (const Row& row : mechanism.pin) add(row, model.alpha, model.beta, none);
    for (const Row& row : mechanism.normal) add(row, model.alpha, model.beta, none);
  }

  Mechanism<T> mechanism;
  T rest_gain{mechanism.model.alpha};  ///< alpha of v' = -alpha v at rest, 1/s: Baumgarte's

  int guides() const { return static_cast<int>(mechanism.model.guide.size()); }
  int contacts() const { return static_cast<int>(mechanism.normal.size()); }
  const typename Model<T>::Guide& guide(int g) const { return mechanism.model.guide[static_cast<std::size_t>(g)]; }
  int first_contact(int g) const {
    return static_cast<int>(std::find(mechanism.guide_of.begin(), mechanism.guide_of.end(), g) -
                            mechanism.guide_of.begin());
  }
  const Row& sliding(int g) const { return mechanism.tangential[static_cast<std::size_t>(first_contact(g))]; }

  // Unknowns: accelerations, then multipliers of joints, drives, pins, contacts, then friction of guides at rest.
  int unknown_of_drive(int d) const { return 3 * mechanism.bodies() + static_cast<int>(mechanism.joint.size()) + d; }
  int unknown_of_pin(int row) const { return unknown_of_drive(static_cast<int>(mechanism.law.size())) + row; }
  int unknown_of_contact(int c) const { return unknown_of_pin(static_cast<int>(mechanism.pin.size())) + c; }

  /// The problem A+ x+ - A- x- = b of the contact forces at the motion of begin(), in the mode's slips: everything else
  /// eliminated, row by row. False if what is left without contacts is singular.
  struct ContactProblem {
    int n;
    std::vector<T> plus, minus, b;
  };
  bool contact_problem(const Mode& mode, const Coefficients<T>& mu, ContactProblem& problem);

  /// From the joints' coordinates to Cartesian ones.
  Motion<T> place(const T& t, const std::vector<T>& q, const std::vector<T>& v) const;

  /// Moves a motion onto the constraints and their rates, and guides at rest to speed zero, by the least change in the
  /// mass metric. False if that fails, or the constraints are redundant there.
  bool project(Motion<T>& motion, const std::vector<bool>& at_rest);

  /// At the motion of begin(), in the order of the KKT system's rows: what joints, drives, pins and contacts are missed
  /// by, or their rates.
  Vector constraint_errors(bool of_rates) const;

  /// Least change in the mass metric that takes `errors` from the constraints and their speeds from the guides in
  /// `stops`, to first order, at the motion of begin(). A guide whose row follows from those before is left to them.
  /// Nothing if the constraints are redundant.
  std::optional<Vector> least_change(const Vector& errors, const std::vector<bool>& stops) const;

  /// |x|, by the masses: of velocities, the root of twice their kinetic energy.
  T size(const Vector& x) const;

  /// The joints' coordinates of a Cartesian change, by the rows' first derivatives at the motion of begin().
  Vector in_joints(const Vector& change) const;

  /// Begins series at a motion: positions to order 1, what depends on speeds to order 0.
  void begin(const Motion<T>& motion);

  /// Begins the solution in a mode at the motion of begin(). False if the KKT matrix is singular there. `applied`: of
  /// each guide that slips, a friction force beside the law's, N; constant.
  bool solve(const Mode& mode, const Coefficients<T>& mu, const std::vector<T>& applied = {});
  /// Extends the solution to the next order.
  void extend();
  /// Extends positions and speeds by what the last order of the solution says: to orders solved() + 1 and solved().
  void extend_positions();
  int solved() const { return static_cast<int>(solution_.size()); }  ///< orders of the solution that are known

  /// The solution of solve() and extend(), order by order.
  const T& unknown(int i, int order) const {
    return solution_[static_cast<std::size_t>(order)][static_cast<std::size_t>(i)];
  }
  const T& lambda(int c, int order) const { return unknown(unknown_of_contact(c), order); }
  /// Friction on the slider along the guide's direction.
  T friction(int g, int order) const;
  /// What is left of the friction limit c Lambda + preload in the direction `side` of the friction force: a guide stays
  /// at rest while both are >= 0.
  T margin(int g, int side, int order) const { return limit(g, order) - T(side) * friction(g, order); }
  /// Sum of the magnitudes of all forces on a body's coordinate in the solution, N | N m: what rounding is relative to.
  T load(int component) const;

 private:
  using Matrix = typename Elimination<T>::Rows;
  struct Constraint {
    const Row* row;
    T alpha, beta;
    int drive;
  };
  struct Entry {
    int row, column;
    Node node;
    T weight;
  };

  static Matrix zero_matrix(int size) {
    return Matrix(static_cast<std::size_t>(size), Vector(static_cast<std::size_t>(size), T(0)));
  }
  Matrix matrix() const;
  bool correct(const std::vector<const Row*>& rows, const Vector& errors, std::vector<T>& x) const;
  std::vector<const Row*> constraint_rows() const;
  void add_row(int equation, int unknown, const Row& row, bool as_constraint);
  void add_force(int unknown, const Row& row, const T& factor);
  void assemble();
  Vector right_side(int k) const;
  void solve_order(int k);
  T limit(int g, int order) const;
  T applied(int g) const { return applied_.empty() ? T(0) : applied_[static_cast<std::size_t>(g)]; }
  bool stuck(int g) const { return guide(g).rough() && mode_.slip[static_cast<std::size_t>(g)] == 0; }

  std::vector<Constraint> constraints_;
  std::vector<std::vector<T>> law_;  ///< of each drive, two orders longer
  Mode mode_;
  Coefficients<T> mu_;
  std::vector<T> applied_;
  std::vector<int> friction_unknown_;  ///< of each guide at rest
  std::vector<Entry> entries_;
  int size_ = 0;
  Elimination<T> factors_;
  std::vector<Vector> solution_;
};

template <class T>
Motion<T> Dynamics<T>::place(const T& t, const std::vector<T>& q, const std::vector<T>& v) const {
  using std::cos, std::sin;
  struct Pose {
    Vec<T> origin, velocity;
    T theta, omega;
  };
  const auto turned = [](const Vec<T>& u, const Vec<T>& r) {
    return Vec<T>{T(u.x * r.x - u.y * r.y), T(u.x * r.y + u.y * r.x)};
  };
  const auto shift = [](Pose& pose, const Vec<T>& r) {  // the origin to r from it, r fixed in the body
    pose.origin = {T(pose.origin.x + r.x), T(pose.origin.y + r.y)};
    pose.velocity = {T(pose.velocity.x - pose.omega * r.y), T(pose.velocity.y + pose.omega * r.x)};
  };
  Motion<T> motion{t, {}, {}};
  std::vector<Pose> poses;
  const Pose at_ground{{T(0), T(0)}, {T(0), T(0)}, T(0), T(0)};
  std::size_t j = 0;
  for (const auto& body : mechanism.model.body) {
    Pose pose = body.parent == ground ? at_ground : poses[static_cast<std::size_t>(body.parent)];
    shift(pose, turned({T(cos(pose.theta)), T(sin(pose.theta))}, body.at));
    pose.theta += body.angle;
    const Vec<T> axes = {T(cos(pose.theta)), T(sin(pose.theta))};
    const bool slides = body.joint == Joint::prismatic || body.joint == Joint::planar;
    if (slides) {
      const bool planar = body.joint == Joint::planar;
      shift(pose, turned(axes, {q[j], planar ? q[j + 1] : T(0)}));
      const Vec<T> along = turned(axes, {v[j], planar ? v[j + 1] : T(0)});
      pose.velocity = {T(pose.velocity.x + along.x), T(pose.velocity.y + along.y)};
      j += planar ? 2 : 1;
    }
    if (body.joint == Joint::revolute || body.joint == Joint::planar) {
      pose.theta += q[j];
      pose.omega += v[j];
      ++j;
    }
    poses.push_back(pose);
    shift(pose, turned({T(cos(pose.theta)), T(sin(pose.theta))}, body.com));
    motion.position.insert(motion.position.end(), {pose.origin.x, pose.origin.y, pose.theta});
    motion.velocity.insert(motion.velocity.end(), {pose.velocity.x, pose.velocity.y, pose.omega});
  }
  return motion;
}

template <class T>
void Dynamics<T>::begin(const Motion<T>& motion) {
  Tape<T>& tape = mechanism.tape;
  for (int i = 0; i < 3 * mechanism.bodies(); ++i) {
    tape.set(mechanism.position(i), 0, motion.position[static_cast<std::size_t>(i)]);
    tape.set(mechanism.position(i), 1, motion.velocity[static_cast<std::size_t>(i)]);
  }
  law_.clear();
  for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
    law_.push_back(law_series(mechanism.model.drive[d], motion.t, tape.orders() + 2));
    for (int k = 0; k < tape.orders(); ++k) tape.set(mechanism.law[d], k, law_[d][static_cast<std::size_t>(k)]);
  }
  tape.extend(0);
}

/// x += the least change in the mass metric that takes `errors` from the rows, to first order.
template <class T>
bool Dynamics<T>::correct(const std::vector<const Row*>& rows, const Vector& errors, std::vector<T>& x) const {
  const std::size_t bodies = x.size(), size = bodies + rows.size();
  Matrix kkt = zero_matrix(static_cast<int>(size));
  for (std::size_t i = 0; i < bodies; ++i) kkt[i][i] = mechanism.mass(static_cast<int>(i));
  for (std::size_t r = bodies; r < size; ++r) {
    const Row& row = *rows[r - bodies];
    const auto set = [&](int body, const std::array<Node, 3>& entry) {
      for (std::size_t j = 0; body != ground && j < 3; ++j) {
        const std::size_t i = static_cast<std::size_t>(3 * body) + j;
        kkt[r][i] = kkt[i][r] = entry[j][0];
      }
    };
    set(row.a, row.on_a);
    set(row.b, row.on_b);
  }
  Vector right(size, T(0));
  for (std::size_t r = bodies; r < size; ++r) right[r] = -errors[r - bodies];
  Elimination<T> factors;
  factors.compute(std::move(kkt));
  if (factors.lost_rank()) return false;
  const Vector change = factors.solve(std::move(right));
  for (std::size_t i = 0; i < bodies; ++i) x[i] += change[i];
  return true;
}

template <class T>
bool Dynamics<T>::project(Motion<T>& motion, const std::vector<bool>& at_rest) {
  using std::abs;
  std::vector<const Row*> rows = constraint_rows();
  constexpr int most_steps = 40;  // Newton doubles the digits: seven from 1 to 1e-50, the rest to come near
  T worst(1);
  for (int step = 0; step < most_steps && worst > 0; ++step) {
    begin(motion);
    const Vector e = constraint_errors(false);
    const T before = worst;
    worst = T(0);
    for (const T& x : e) worst = std::max(worst, T(abs(x)));
    if (step > 0 && worst >= before && worst < zero_tolerance<T>()) break;  // rounding
    if (!correct(rows, e, motion.position)) return false;
  }
  if (!(worst < zero_tolerance<T>())) return false;
  begin(motion);
  const Vector rates = constraint_errors(true);
  const auto free = least_change(rates, std::vector<bool>(at_rest.size(), false)), held = least_change(rates, at_rest);
  if (!free || !held) return false;
  // Where guides at rest nearly follow from the constraints, as at a dead centre, they would stop the whole mechanism,
  // which only rounding of their speeds was to leave.
  Vector velocity = motion.velocity;
  T stopped(0), most(0);
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    velocity[i] += (*free)[i];
    motion.velocity[i] += (*held)[i];
    stopped = std::max(stopped, T(abs(motion.velocity[i] - velocity[i])));
    most = std::max(most, T(abs(velocity[i])));
  }
  if (stopped > T(0x1p-20) * most) motion.velocity = velocity;
  return true;
}

template <class T>
std::vector<const typename Dynamics<T>::Row*> Dynamics<T>::constraint_rows() const {
  std::vector<const Row*> rows;
  for (const Constraint& c : constraints_) rows.push_back(c.row);
  return rows;
}

template <class T>
typename Dynamics<T>::Vector Dynamics<T>::constraint_errors(bool of_rates) const {
  Vector errors;
  for (const Constraint& c : constraints_) {
    errors.push_back(of_rates ? c.row->speed[0] : c.row->value[0]);
    if (c.drive != none) errors.back() -= law_[static_cast<std::size_t>(c.drive)][of_rates ? 1 : 0];
  }
  return errors;
}

template <class T>
std::optional<typename Dynamics<T>::Vector> Dynamics<T>::least_change(const Vector& errors,
                                                                      const std::vector<bool>& stops) const {
  const Vector nothing(static_cast<std::size_t>(3 * mechanism.bodies()), T(0));
  std::vector<const Row*> rows = constraint_rows();
  Vector right = errors, change = nothing;
  if (!correct(rows, right, change)) return std::nullopt;
  for (int g = 0; g < guides(); ++g) {
    if (!stops[static_cast<std::size_t>(g)]) continue;
    rows.push_back(&sliding(g));
    right.push_back(sliding(g).speed[0]);
    Vector with_it = nothing;
    if (correct(rows, right, with_it)) {
      change = with_it;
    } else {
      rows.pop_back();
      right.pop_back();
    }
  }
  return change;
}

template <class T>
T Dynamics<T>::size(const Vector& x) const {
  using std::sqrt;
  T sum(0);
  for (std::size_t i = 0; i < x.size(); ++i) sum += mechanism.mass(static_cast<int>(i)) * x[i] * x[i];
  return sqrt(sum);
}

template <class T>
typename Dynamics<T>::Vector Dynamics<T>::in_joints(const Vector& change) const {
  Vector q;
  for (const Row& row : mechanism.coordinate) {
    q.push_back(T(0));
    const auto add = [&](int body, const std::array<Node, 3>& entry) {
      for (std::size_t j = 0; body != ground && j < 3; ++j) {
        q.back() += entry[j][0] * change[static_cast<std::size_t>(3 * body) + j];
      }
    };
    add(row.a, row.on_a);
    add(row.b, row.on_b);
  }
  return q;
}

template <class T>
T Dynamics<T>::load(int component) const {
  using std::abs;
  T sum = abs(mechanism.force[static_cast<std::size_t>(component)][0]);
  for (const Entry& e : entries_) {
    if (e.row == component && e.column != component) sum += abs(e.weight * e.node[0] * unknown(e.column, 0));
  }
  return sum;
}

template <class T>
bool Dynamics<T>::solve(const Mode& mode, const Coefficients<T>& mu, const std::vector<T>& applied) {
  mode_ = mode;
  mu_ = mu;
  applied_ = applied;
  solution_.clear();
  assemble();
  factors_.compute(matrix());
  if (factors_.lost_rank()) return false;
  solve_order(0);
  return true;
}

template <class T>
void Dynamics<T>::extend_positions() {
  const int k = solved();
  for (int i = 0; i < 3 * mechanism.bodies(); ++i) {
    mechanism.tape.set(mechanism.position(i), k + 1, T(unknown(i, k - 1) / T(k * (k + 1))));
  }
  mechanism.tape.extend(k);
}

template <class T>
void Dynamics<T>::extend() {
  extend_positions();
  solve_order(solved());
}

template <class T>
typename Dynamics<T>::Matrix Dynamics<T>::matrix() const {
  Matrix rows = zero_matrix(size_);
  for (const Entry& e : entries_) {
    rows[static_cast<std::size_t>(e.row)][static_cast<std::size_t>(e.column)] += e.weight * e.node[0];
  }
  return rows;
}

template <class T>
bool Dynamics<T>::contact_problem(const Mode& mode, const Coefficients<T>& mu, ContactProblem& problem) {
  const auto n = static_cast<std::size_t>(contacts()), first = static_cast<std::size_t>(unknown_of_contact(0));
  mode_ = mode;
  mu_ = mu;
  applied_.clear();
  const auto with_signs = [&](int sign) {
    mode_.sign.assign(n, sign);
    assemble();
    return matrix();
  };
  const Matrix plus = with_signs(1), minus = with_signs(-1);
  const auto without_contacts = [&](Vector x) {
    x.erase(x.begin() + static_cast<std::ptrdiff_t>(first), x.begin() + static_cast<std::ptrdiff_t>(first + n));
    return x;
  };
  Matrix rest;
  for (std::size_t i = 0; i < plus.size(); ++i) {
    if (i < first || i >= first + n) rest.push_back(without_contacts(plus[i]));
  }
  Elimination<T> factors;
  factors.compute(std::move(rest));
  if (factors.lost_rank()) return false;
  const auto response = [&](const Vector& whole) {  // of each contact's row
    const Vector x = factors.solve(without_contacts(whole));
    Vector in_rows(n, T(0));
    for (std::size_t i = 0; i < n; ++i) {
      const Vector row = without_contacts(plus[first + i]);
      for (std::size_t j = 0; j < x.size(); ++j) in_rows[i] += row[j] * x[j];
    }
    return in_rows;
  };
  const auto column = [&](const Matrix& from, std::size_t contact) {
    Vector x;
    for (const Vector& row : from) x.push_back(row[first + contact]);
    return response(x);
  };
  problem = {contacts(), Vector(n * n), Vector(n * n), Vector(n)};
  for (std::size_t j = 0; j < n; ++j) {
    const Vector of_plus = column(plus, j), of_minus = column(minus, j);
    for (std::size_t i = 0; i < n; ++i) {
      problem.plus[i * n + j] = -of_plus[i];
      problem.minus[i * n + j] = -of_minus[i];
    }
  }
  const Vector right = right_side(0), free = response(right);
  for (std::size_t i = 0; i < n; ++i) problem.b[i] = right[first + i] - free[i];
  return true;
}

/// The multiplier's column, and for a constraint its row.
template <class T>
void Dynamics<T>::add_row(int equation, int unknown, const Row& row, bool as_constraint) {
  const auto add = [&](int body, const std::array<Node, 3>& entry) {
    if (body == ground) return;
    for (int j = 0; j < 3; ++j) {
      const Node& node = entry[static_cast<std::size_t>(j)];
      if (node.is_zero()) continue;
      if (as_constraint) entries_.push_back({equation, 3 * body + j, node, T(1)});
      entries_.push_back({3 * body + j, unknown, node, T(-1)});
    }
  };
  add(row.a, row.on_a);
  add(row.b, row.on_b);
}

/// A force along the row of `factor` times an unknown.
template <class T>
void Dynamics<T>::add_force(int unknown, const Row& row, const T& factor) {
  const std::size_t first = entries_.size();
  add_row(unknown, unknown, row, false);
  for (std::size_t e = first; e < entries_.size(); ++e) entries_[e].weight *= factor;
}

template <class T>
void Dynamics<T>::assemble() {
  entries_.clear();
  const int bodies = 3 * mechanism.bodies();
  for (int i = 0; i < bodies; ++i) entries_.push_back({i, i, Node(mechanism.mass(i)), T(1)});
  size_ = bodies;
  for (const Constraint& c : constraints_) {
    add_row(size_, size_, *c.row, true);
    ++size_;
  }
  friction_unknown_.assign(static_cast<std::size_t>(guides()), none);
  for (int g = 0; g < guides(); ++g) {
    if (!stuck(g)) continue;
    add_row(size_, size_, sliding(g), true);
    friction_unknown_[static_cast<std::size_t>(g)] = size_++;
  }
  for (int c = 0; c < contacts(); ++c) {
    const auto at = static_cast<std::size_t>(c);
    const auto g = static_cast<std::size_t>(mechanism.guide_of[at]);
    if (mode_.slip[g] == 0) continue;
    add_force(unknown_of_contact(c), mechanism.tangential[at], T(-mu_[g] * T(mode_.slip[g] * mode_.sign[at])));
  }
}

template <class T>
typename Dynamics<T>::Vector Dynamics<T>::right_side(int k) const {
  Vector b(static_cast<std::size_t>(size_), T(0));
  for (std::size_t i = 0; i < mechanism.force.size(); ++i) b[i] = mechanism.force[i][k];
  std::size_t equation = mechanism.force.size();
  for (const Constraint& c : constraints_) {
    b[equation] = -(c.row->turning[k] + c.alpha * c.row->speed[k] + c.beta * c.row->value[k]);
    if (c.drive != none) {
      const auto& f = law_[static_cast<std::size_t>(c.drive)];
      const auto o = static_cast<std::size_t>(k);
      b[equation] += T((k + 1) * (k + 2)) * f[o + 2] + c.alpha * T(k + 1) * f[o + 1] + c.beta * f[o];
    }
    ++equation;
  }
  for (int g = 0; g < guides(); ++g) {
    const Row& row = sliding(g);
    if (stuck(g)) b[equation++] = -(row.turning[k] + rest_gain * row.speed[k]);
    const T steady = applied(g) - T(mode_.slip[static_cast<std::size_t>(g)]) * guide(g).preload;
    if (steady == 0) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      if (row.a != ground) b[static_cast<std::size_t>(3 * row.a) + j] += steady * row.on_a[j][k];
      if (row.b != ground) b[static_cast<std::size_t>(3 * row.b) + j] += steady * row.on_b[j][k];
    }
  }
  return b;
}

template <class T>
void Dynamics<T>::solve_order(int k) {
  Vector b = right_side(k);
  for (const Entry& e : entries_) {
    if (e.node.is_constant()) continue;
    T sum(0);
    for (int j = 1; j <= k; ++j) sum += e.node[j] * unknown(e.column, k - j);
    b[static_cast<std::size_t>(e.row)] -= e.weight * sum;
  }
  solution_.push_back(factors_.solve(std::move(b)));
}

template <class T>
T Dynamics<T>::friction(int g, int order) const {
  const T viscous = guide(g).viscous * sliding(g).speed[order];
  if (stuck(g)) return unknown(friction_unknown_[static_cast<std::size_t>(g)], order) - viscous;
  return (order == 0 ? applied(g) : T(0)) - T(mode_.slip[static_cast<std::size_t>(g)]) * limit(g, order) - viscous;
}

template <class T>
T Dynamics<T>::limit(int g, int order) const {
  T sum = order == 0 ? guide(g).preload : T(0);
  for (int c = 0; c < contacts(); ++c) {
    if (mechanism.guide_of[static_cast<std::size_t>(c)] != g) continue;
    sum += mu_[static_cast<std::size_t>(g)] * T(mode_.sign[static_cast<std::size_t>(c)]) * lambda(c, order);
  }
  return sum;
}

extern template class Dynamics<Real>;

}  // namespace slideway::oracle
