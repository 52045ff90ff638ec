// Kinematics and dynamics of random mechanisms against a second formulation: Cartesian coordinates of every body, all
// constraints kept, time derivatives by Taylor arithmetic, the whole KKT system by Gauss with complete pivoting,
// contact signs by trying all of them, long double. It has the frames and definitions of scene.hpp and none of the
// kernel's code.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <slideway/step.hpp>
#include <support/litter.hpp>
#include <vector>

// Doubles are promoted on purpose: what is compared with is computed in long double.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

namespace {

using slideway::ground;
using slideway::Joint;
using slideway::Law;
using slideway::none;
using slideway::Report;
using slideway::Status;
using Real = long double;

using Size = slideway::Size<7, 21, 4, 8, 3, 2, 2, 2, 2, 2>;
using Scene = slideway::Scene<Size>;
using Stepper = slideway::RunTimeStepper<Size>;

// --- second formulation: motion --------------------------------------------------------------------------------------

/// A function of time to second order: value, first and second derivative.
struct Jet {
  Real x = 0, d = 0, dd = 0;
};
Jet operator+(Jet a, Jet b) { return {a.x + b.x, a.d + b.d, a.dd + b.dd}; }
Jet operator-(Jet a, Jet b) { return {a.x - b.x, a.d - b.d, a.dd - b.dd}; }
Jet operator*(Jet a, Jet b) { return {a.x * b.x, a.d * b.x + a.x * b.d, a.dd * b.x + 2 * a.d * b.d + a.x * b.dd}; }
Jet operator*(Real s, Jet a) { return {s * a.x, s * a.d, s * a.dd}; }
/// f(a), given f, f' and f'' at a.x.
Jet chain(Jet a, Real f, Real f1, Real f2) { return {f, f1 * a.d, f2 * a.d * a.d + f1 * a.dd}; }
Jet cos(Jet a) { return chain(a, std::cos(a.x), -std::sin(a.x), -std::cos(a.x)); }
Jet sin(Jet a) { return chain(a, std::sin(a.x), std::cos(a.x), -std::sin(a.x)); }
Jet sqrt(Jet a) {
  const Real root = std::sqrt(a.x);
  return chain(a, root, 1 / (2 * root), -1 / (4 * root * a.x));
}
Real cos(Real a) { return std::cos(a); }
Real sin(Real a) { return std::sin(a); }

template <class T>
struct Vec {
  T x{}, y{};
};
template <class T>
Vec<T> operator+(Vec<T> a, Vec<T> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
Vec<T> operator-(Vec<T> a, Vec<T> b) {
  return {a.x - b.x, a.y - b.y};
}
/// r turned by an angle.
template <class T>
Vec<T> turned(Vec<T> r, T angle) {
  const T c = cos(angle), s = sin(angle);
  return {c * r.x - s * r.y, s * r.x + c * r.y};
}
template <class T>
Vec<T> turned(slideway::Vec2 r, T angle) {
  const T c = cos(angle), s = sin(angle);
  return {Real{r.x} * c - Real{r.y} * s, Real{r.x} * s + Real{r.y} * c};
}
template <class T>
T constant(Real value) {
  T c{};
  if constexpr (std::is_same_v<T, Jet>) {
    c.x = value;
  } else {
    c = value;
  }
  return c;
}

/// A body's frame: its origin and its angle.
template <class T>
struct Pose {
  Vec<T> o;
  T angle{};
};

template <class T>
using Poses = std::array<Pose<T>, Size::bodies>;

template <class T>
Pose<T> pose_of(const Poses<T>& poses, int body) {
  return body == ground ? Pose<T>{} : poses[body];
}

/// scene.hpp's frames, from tree coordinates.
template <class T>
Poses<T> place(const Scene& scene, const T* q) {
  Poses<T> poses;
  for (int i = 0, j = 0; i < scene.bodies; ++i) {
    const auto& body = scene.body[i];
    const Pose<T> p = pose_of(poses, body.parent);
    Pose<T>& b = poses[i];
    b.o = p.o + turned(body.at, p.angle);
    const T frame = p.angle + constant<T>(body.angle);
    b.angle = frame;
    if (body.joint == Joint::revolute) b.angle = frame + q[j];
    if (body.joint == Joint::prismatic) b.o = b.o + turned(Vec<T>{q[j], {}}, frame);
    if (body.joint == Joint::planar) {
      b.o = b.o + turned(Vec<T>{q[j], q[j + 1]}, frame);
      b.angle = frame + q[j + 2];
    }
    j += coordinates(body.joint);
  }
  return poses;
}

template <class T>
Vec<T> point(const Poses<T>& poses, int body, slideway::Vec2 at) {
  const Pose<T> pose = pose_of(poses, body);
  return pose.o + turned(at, pose.angle);
}

/// A point as it is seen in a body's frame.
template <class T>
Vec<T> seen_from(const Poses<T>& poses, int body, Vec<T> r) {
  const Pose<T> pose = pose_of(poses, body);
  return turned(r - pose.o, constant<T>(0) - pose.angle);
}

/// Where a contact is in the frame (t, n) of its guide's line: along it, and off it, which is Phi.
template <class T>
Vec<T> on_line(const Scene& scene, const Poses<T>& poses, int g, int contact) {
  const auto& guide = scene.guide[g];
  Vec<T> r = seen_from(poses, guide.rail, point(poses, guide.slider, guide.contact[contact]));
  r = r - Vec<T>{constant<T>(guide.origin.x), constant<T>(guide.origin.y)};
  return turned(r, constant<T>(-std::atan2(Real{guide.direction.y}, Real{guide.direction.x})));
}

/// A pin's miss in the frame of its body b.
template <class T>
Vec<T> gap(const Scene& scene, const Poses<T>& poses, int p) {
  const auto& pin = scene.pin[p];
  return seen_from(poses, pin.b, point(poses, pin.a, pin.a_at)) -
         Vec<T>{constant<T>(pin.b_at.x), constant<T>(pin.b_at.y)};
}

/// The three relative coordinates of a body against its joint's frame.
std::array<Jet, 3> relative(const Scene& scene, const Poses<Jet>& poses, int i) {
  const auto& body = scene.body[i];
  const Pose<Jet> p = pose_of(poses, body.parent);
  const Jet frame = p.angle + constant<Jet>(body.angle);
  const Vec<Jet> r = turned(poses[i].o - point(poses, body.parent, body.at), Jet{} - frame);
  return {r.x, r.y, poses[i].angle - frame};
}

/// Which of those three are coordinates, in their order; the rest the joint holds at zero.
std::vector<int> freedoms(Joint joint) {
  switch (joint) {
    case Joint::revolute:
      return {2};
    case Joint::prismatic:
      return {0};
    case Joint::planar:
      return {0, 1, 2};
    case Joint::fixed:
      break;
  }
  return {};
}

// --- second formulation: forces --------------------------------------------------------------------------------------

/// Everything in a mechanism that has a rate and an acceleration, as jets.
struct Measures {
  std::vector<Jet> joint, coordinate, off, along, pin, spring, load;
  std::vector<const std::vector<Jet>*> all() const { return {&joint, &coordinate, &off, &along, &pin, &spring, &load}; }
};

Measures measure(const Scene& scene, const Poses<Jet>& poses) {
  Measures m;
  for (int i = 0; i < scene.bodies; ++i) {
    const auto r = relative(scene, poses, i);
    const auto free = freedoms(scene.body[i].joint);
    for (int k = 0; k < 3; ++k) {
      const bool is_free = std::find(free.begin(), free.end(), k) != free.end();
      (is_free ? m.coordinate : m.joint).push_back(r[k]);
    }
  }
  for (int g = 0; g < scene.guides; ++g) {
    for (int c = 0; c < scene.guide[g].contacts; ++c) {
      const Vec<Jet> r = on_line(scene, poses, g, c);
      m.along.push_back(r.x);
      m.off.push_back(r.y);
    }
  }
  for (int p = 0; p < scene.pins; ++p) {
    const Vec<Jet> r = gap(scene, poses, p);
    m.pin.push_back(r.x);
    m.pin.push_back(r.y);
  }
  for (int s = 0; s < scene.springs; ++s) {
    const Vec<Jet> r =
        point(poses, scene.spring[s].a, scene.spring[s].a_at) - point(poses, scene.spring[s].b, scene.spring[s].b_at);
    m.spring.push_back(sqrt(r.x * r.x + r.y * r.y));
  }
  for (int l = 0; l < scene.loads; ++l) {
    const Vec<Jet> r = point(poses, scene.load[l].body, scene.load[l].at);
    m.load.push_back(r.x);
    m.load.push_back(r.y);
    m.load.push_back(pose_of(poses, scene.load[l].body).angle);
  }
  return m;
}

/// Poses from centres of mass and angles, three a body.
Poses<Jet> poses_from(const Scene& scene, const std::vector<Jet>& x) {
  Poses<Jet> poses;
  for (int i = 0; i < scene.bodies; ++i) {
    poses[i].angle = x[3 * i + 2];
    poses[i].o = Vec<Jet>{x[3 * i], x[3 * i + 1]} - turned(scene.body[i].com, poses[i].angle);
  }
  return poses;
}

/// A drive's law, its rate and its acceleration, straight from scene.hpp.
Jet law_of(const slideway::Drive& drive, const slideway::Inputs<Size>& inputs, Real time) {
  const Jet t{time, 1, 0};
  if (drive.law == Law::input) {
    const auto& in = inputs.input[drive.input];
    return {in.value, in.rate, in.acceleration};
  }
  if (drive.law == Law::uniform) return constant<Jet>(drive.c[0]) + Real{drive.c[1]} * t;
  if (drive.law == Law::harmonic) {
    return constant<Jet>(drive.c[0]) + Real{drive.c[1]} * sin(Real{drive.c[2]} * t + constant<Jet>(drive.c[3]));
  }
  Jet sum, power = constant<Jet>(1);
  for (int k = 0; k < drive.terms; ++k, power = power * t) sum = sum + Real{drive.c[k]} * power;
  return sum;
}

using Matrix = std::vector<std::vector<Real>>;

/// Solves A x = b by Gauss with complete pivoting; returns the smallest pivot over the largest (x is left alone where
/// that is zero).
Real gauss(Matrix A, std::vector<Real> b, std::vector<Real>& x) {
  const int n = static_cast<int>(b.size());
  std::vector<int> column(n);
  for (int j = 0; j < n; ++j) column[j] = j;
  Real largest = 0, least = 0;
  for (int k = 0; k < n; ++k) {
    int row = k, col = k;
    for (int i = k; i < n; ++i) {
      for (int j = k; j < n; ++j) {
        if (std::fabs(A[i][j]) > std::fabs(A[row][col])) row = i, col = j;
      }
    }
    std::swap(A[k], A[row]);
    std::swap(b[k], b[row]);
    for (auto& r : A) std::swap(r[k], r[col]);
    std::swap(column[k], column[col]);
    least = std::fabs(A[k][k]);
    if (k == 0) largest = least;
    if (least == 0) return 0;
    for (int i = k + 1; i < n; ++i) {
      const Real f = A[i][k] / A[k][k];
      for (int j = k; j < n; ++j) A[i][j] -= f * A[k][j];
      b[i] -= f * b[k];
    }
  }
  std::vector<Real> y(n);
  for (int k = n - 1; k >= 0; --k) {
    y[k] = b[k];
    for (int j = k + 1; j < n; ++j) y[k] -= A[k][j] * y[j];
    y[k] /= A[k][k];
  }
  x.assign(n, 0);
  for (int k = 0; k < n; ++k) x[column[k]] = y[k];
  return least / largest;
}

/// What the second formulation finds for a mechanism at an instant.
struct Instant {
  std::vector<Real> acceleration, lambda, friction, slip, drive;
  std::vector<Vec<Real>> pin;
  Real work = 0, dissipated = 0, constraint_work = 0;  ///< W
  Real energy_rate = 0;                                ///< d/dt of kinetic and potential energy, W
  Real drift_position = 0, drift_velocity = 0;
  Real kinetic = 0, potential = 0;  ///< J
  int solutions = 0;                ///< sign patterns that hold
  Real condition = 1;               ///< smallest over largest pivot, the worst of all patterns
  Real margin = 1;                  ///< smallest |lambda| of a pattern over its largest: how near to a tie
};

Instant solve(const Scene& scene, const Stepper::State& state, const slideway::Inputs<Size>& inputs) {
  Instant result;
  const int bodies = 3 * scene.bodies;
  const Real alpha = scene.alpha, beta = scene.beta;

  // The state: tree -> poses and velocities -> centres of mass.
  std::vector<Jet> q(Size::coordinates), x(bodies);
  for (int j = 0; j < Size::coordinates; ++j) q[j] = {state.q[j], state.v[j], 0};
  const Poses<Jet> tree = place(scene, q.data());
  for (int i = 0; i < scene.bodies; ++i) {
    const Vec<Jet> c = point(tree, i, scene.body[i].com);
    x[3 * i] = c.x;
    x[3 * i + 1] = c.y;
    x[3 * i + 2] = tree[i].angle;
  }
  for (Jet& coordinate : x) coordinate.dd = 0;

  // Every measure's second derivative is affine in the accelerations: J x'' + gamma.
  const Measures base = measure(scene, poses_from(scene, x));
  std::vector<Measures> unit;
  for (int i = 0; i < bodies; ++i) {
    std::vector<Jet> y = x;
    y[i].dd = 1;
    unit.push_back(measure(scene, poses_from(scene, y)));
  }
  const auto jacobian = [&](std::vector<Jet> Measures::*kind, int k, int i) {
    return (unit[i].*kind)[k].dd - (base.*kind)[k].dd;
  };

  // Applied forces.
  std::vector<Real> force(bodies, 0);
  const auto apply = [&](std::vector<Jet> Measures::*kind, int k, Real f) {
    for (int i = 0; i < bodies; ++i) force[i] += f * jacobian(kind, k, i);
  };
  std::vector<int> first(scene.bodies);
  for (int i = 0, j = 0; i < scene.bodies; j += coordinates(scene.body[i++].joint)) first[i] = j;
  for (int i = 0; i < scene.bodies; ++i) {
    const auto& body = scene.body[i];
    force[3 * i] += Real{body.mass} * scene.gravity.x;
    force[3 * i + 1] += Real{body.mass} * scene.gravity.y;
    result.kinetic += Real{body.mass} * (x[3 * i].d * x[3 * i].d + x[3 * i + 1].d * x[3 * i + 1].d) / 2 +
                      Real{body.inertia} * x[3 * i + 2].d * x[3 * i + 2].d / 2;
    result.potential -= Real{body.mass} * (scene.gravity.x * x[3 * i].x + scene.gravity.y * x[3 * i + 1].x);
  }
  for (int s = 0; s < scene.springs; ++s) {
    const auto& spring = scene.spring[s];
    const Jet length = base.spring[s];
    const Real stretch = length.x - spring.length;
    apply(&Measures::spring, s, -spring.stiffness * stretch - spring.damping * length.d);
    result.potential += spring.stiffness * stretch * stretch / 2;
    result.energy_rate += spring.stiffness * stretch * length.d;
    result.dissipated += spring.damping * length.d * length.d;
  }
  for (int s = 0; s < scene.joint_springs; ++s) {
    const auto& spring = scene.joint_spring[s];
    const int j = first[spring.body];
    const Jet c = base.coordinate[j];
    const Real stretch = c.x - spring.rest;
    apply(&Measures::coordinate, j, -spring.stiffness * stretch - spring.damping * c.d);
    result.potential += spring.stiffness * stretch * stretch / 2;
    result.energy_rate += spring.stiffness * stretch * c.d;
    result.dissipated += spring.damping * c.d * c.d;
  }
  for (int l = 0; l < scene.loads; ++l) {
    const auto& load = scene.load[l];
    const Real scale = load.input == none ? 1 : inputs.input[load.input].value;
    const Real part[3] = {scale * load.force.x, scale * load.force.y, scale * load.torque};
    for (int k = 0; k < 3; ++k) {
      apply(&Measures::load, 3 * l + k, part[k]);
      result.work += part[k] * base.load[3 * l + k].d;
    }
  }

  // Constraints: a measure, its index, and what its second derivative has to be.
  struct Row {
    std::vector<Jet> Measures::*kind;
    int index;
    Real target;
  };
  std::vector<Row> rows;
  const auto drift = [&](Real position, Real velocity) {
    result.drift_position = std::fmax(result.drift_position, std::fabs(position));
    result.drift_velocity = std::fmax(result.drift_velocity, std::fabs(velocity));
  };
  for (int k = 0; k < static_cast<int>(base.joint.size()); ++k) rows.push_back({&Measures::joint, k, 0});
  const int first_drive = static_cast<int>(rows.size());
  for (int d = 0; d < scene.drives; ++d) {
    const int j = first[scene.drive[d].body] + scene.drive[d].axis;
    const Jet law = law_of(scene.drive[d], inputs, state.time()), phi = base.coordinate[j] - law;
    drift(phi.x, phi.d);
    rows.push_back({&Measures::coordinate, j, law.dd - alpha * phi.d - beta * phi.x});
  }
  const int first_contact = static_cast<int>(rows.size());
  for (int c = 0; c < contacts(scene); ++c) {
    const Jet Phi = base.off[c];
    drift(Phi.x, Phi.d);
    rows.push_back({&Measures::off, c, -alpha * Phi.d - beta * Phi.x});
  }
  const int first_pin = static_cast<int>(rows.size());
  for (int p = 0; p < 2 * scene.pins; ++p) {
    const Jet Phi = base.pin[p];
    rows.push_back({&Measures::pin, p, -alpha * Phi.d - beta * Phi.x});
  }
  const auto in_world = [&](int p, Real u, Real v) {
    return turned(Vec<Real>{u, v}, pose_of(tree, scene.pin[p].b).angle.x);
  };
  for (int p = 0; p < scene.pins; ++p) {
    const Vec<Real> Phi = in_world(p, base.pin[2 * p].x, base.pin[2 * p + 1].x);
    const Vec<Real> rate = in_world(p, base.pin[2 * p].d, base.pin[2 * p + 1].d);
    drift(Phi.x, rate.x);
    drift(Phi.y, rate.y);
  }

  // [M  -G' - T' sigma] [x''    ]   [force         ]
  // [G        0       ] [lambda ] = [target - gamma]
  const int n = bodies + static_cast<int>(rows.size());
  Matrix kkt(n, std::vector<Real>(n, 0));
  std::vector<Real> right(n);
  for (int i = 0; i < bodies; ++i) {
    kkt[i][i] = i % 3 == 2 ? scene.body[i / 3].inertia : scene.body[i / 3].mass;
    right[i] = force[i];
  }
  for (int r = 0; r < n - bodies; ++r) {
    for (int i = 0; i < bodies; ++i) {
      kkt[bodies + r][i] = jacobian(rows[r].kind, rows[r].index, i);
      kkt[i][bodies + r] = -kkt[bodies + r][i];
    }
    right[bodies + r] = rows[r].target - (base.*rows[r].kind)[rows[r].index].dd;
  }

  // Sign patterns of the contacts with friction. The guide's first contact decides the direction of its friction.
  std::vector<int> rough, guide_of(contacts(scene));
  std::vector<Real> direction(scene.guides);
  for (int g = 0, c = 0; g < scene.guides; ++g) {
    result.slip.push_back(base.along[c].d);
    direction[g] = result.slip[g] > 0 ? 1 : -1;
    for (int k = 0; k < scene.guide[g].contacts; ++k, ++c) {
      guide_of[c] = g;
      if (scene.guide[g].mu > 0) rough.push_back(c);
    }
  }
  std::vector<Real> solution;
  for (unsigned pattern = 0; pattern < 1u << rough.size(); ++pattern) {
    Matrix matrix = kkt;
    for (std::size_t m = 0; m < rough.size(); ++m) {
      const int c = rough[m], g = guide_of[c];
      const Real sign = (pattern >> m & 1u) != 0 ? -1 : 1, sigma = -scene.guide[g].mu * direction[g] * sign;
      for (int i = 0; i < bodies; ++i) {
        matrix[i][bodies + first_contact + c] -= sigma * jacobian(&Measures::along, c, i);
      }
    }
    std::vector<Real> y;
    result.condition = std::fmin(result.condition, gauss(matrix, right, y));
    if (y.empty()) continue;
    bool holds = true;
    Real least = -1, most = 0;
    for (std::size_t m = 0; m < rough.size(); ++m) {
      const Real force_c = y[bodies + first_contact + rough[m]];
      holds = holds && force_c * ((pattern >> m & 1u) != 0 ? -1 : 1) >= 0;
      least = least < 0 ? std::fabs(force_c) : std::fmin(least, std::fabs(force_c));
      most = std::fmax(most, std::fabs(force_c));
    }
    if (most > 0) result.margin = std::fmin(result.margin, least / most);
    if (!holds) continue;
    ++result.solutions;
    solution = y;
  }
  if (result.solutions != 1) return result;

  std::vector<Jet> moving = x;
  for (int i = 0; i < bodies; ++i) {
    moving[i].dd = solution[i];
    const Real mass = kkt[i][i];
    result.energy_rate += mass * x[i].d * solution[i];
    if (i % 3 < 2) result.energy_rate -= mass * (i % 3 == 0 ? scene.gravity.x : scene.gravity.y) * x[i].d;
  }
  for (const Jet& c : measure(scene, poses_from(scene, moving)).coordinate) result.acceleration.push_back(c.dd);
  const Real* multiplier = solution.data() + bodies;
  result.friction.assign(scene.guides, 0);
  for (int c = 0; c < contacts(scene); ++c) {
    const Real lambda = multiplier[first_contact + c];
    const Real friction = -scene.guide[guide_of[c]].mu * direction[guide_of[c]] * std::fabs(lambda);
    result.lambda.push_back(lambda);
    result.friction[guide_of[c]] += friction;
    const Real slip = result.slip[guide_of[c]];  // at the first contact; what another slips beyond it is drift
    result.dissipated -= friction * slip;
    result.constraint_work += lambda * base.off[c].d + friction * (base.along[c].d - slip);
  }
  for (int p = 0; p < scene.pins; ++p) {
    const Real* pi = multiplier + first_pin + 2 * p;
    result.pin.push_back(in_world(p, pi[0], pi[1]));
    result.constraint_work += pi[0] * base.pin[2 * p].d + pi[1] * base.pin[2 * p + 1].d;
  }
  for (int d = 0; d < scene.drives; ++d) {
    result.drive.push_back(multiplier[first_drive + d]);
    result.work += multiplier[first_drive + d] * base.coordinate[rows[first_drive + d].index].d;
  }
  return result;
}

// --- random mechanisms -----------------------------------------------------------------------------------------------

/// Numbers that are the same everywhere: the generator is the standard's, its distributions are not.
struct Random {
  std::mt19937 bits;
  explicit Random(unsigned seed) : bits(seed) {}
  double between(double a, double b) { return a + (b - a) * (static_cast<double>(bits()) * 0x1p-32); }
  int below(int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); }
  slideway::Vec2 point() { return {between(-1, 1), between(-1, 1)}; }
};

struct Mechanism {
  Scene scene;
  Stepper::State state;
  slideway::Inputs<Size> inputs;
};

/// A mechanism with joints of all kinds (the first of them drawn), two or three guides, at least one of them with
/// friction up to `most_mu`, and some of everything else, in a random pose that misses its constraints and moves off
/// them. Its constraints may be dependent.
Mechanism draw(Random& random, double most_mu) {
  Mechanism m;
  Scene& scene = m.scene;
  scene.gravity = random.point();
  scene.gravity.y -= 9;
  scene.alpha = random.between(0, 30);
  scene.beta = random.between(0, 200);
  scene.inputs = 2;
  scene.bodies = 4 + random.below(4);
  const int shift = random.below(4);
  for (int i = 0; i < scene.bodies; ++i) {
    auto& body = scene.body[i];
    body.parent = random.below(i + 1) - 1;
    body.joint = static_cast<Joint>((i + shift) % 4);
    body.at = random.below(4) == 0 ? slideway::Vec2{} : random.point();
    if (random.below(2) == 0) body.angle = random.between(-3, 3);
    body.turn = {std::cos(body.angle), std::sin(body.angle)};
    const bool may_be_massless = body.joint == Joint::revolute || body.joint == Joint::fixed;  // M stays definite
    body.mass = may_be_massless && random.below(4) == 0 ? 0 : random.between(0.2, 3);
    body.com = random.below(4) == 0 ? slideway::Vec2{} : random.point();
    body.inertia = random.between(0.05, 1);
  }
  scene.drives = 1 + random.below(2);
  for (int d = 0; d < scene.drives; ++d) {
    auto& drive = scene.drive[d];
    do {
      drive.body = random.below(scene.bodies);
    } while (scene.body[drive.body].joint == Joint::fixed || (d > 0 && drive.body == scene.drive[0].body));
    drive.axis = random.below(coordinates(scene.body[drive.body].joint));
    drive.law = static_cast<Law>(random.below(4));
    drive.terms = 1 + random.below(8);
    drive.input = 0;
    for (double& c : drive.c) c = random.between(-1, 1);
  }
  const auto two = [&](int& a, int& b) {
    a = random.below(scene.bodies);
    do {
      b = random.below(scene.bodies + 1) - 1;
    } while (b == a);
  };
  scene.guides = 2 + random.below(2);
  for (int g = 0; g < scene.guides; ++g) {
    auto& guide = scene.guide[g];
    two(guide.slider, guide.rail);
    guide.origin = random.below(4) == 0 ? slideway::Vec2{} : random.point();
    guide.direction = random.below(4) == 0 ? slideway::Vec2{0, 2} : random.point();
    const double length = std::hypot(guide.direction.x, guide.direction.y);
    guide.tangent = {guide.direction.x / length, guide.direction.y / length};
    guide.contacts = 1 + random.below(2);
    for (auto& contact : guide.contact) contact = random.below(4) == 0 ? slideway::Vec2{} : random.point();
    guide.mu = g > 0 && random.below(3) == 0 ? 0 : random.between(0.02, most_mu);
    guide.mu_static = guide.mu;
  }
  scene.pins = random.below(2);
  for (int p = 0; p < scene.pins; ++p) {
    two(scene.pin[p].a, scene.pin[p].b);
    scene.pin[p].a_at = random.point();
    scene.pin[p].b_at = random.point();
  }
  scene.springs = 1 + random.below(2);
  for (int s = 0; s < scene.springs; ++s) {
    auto& spring = scene.spring[s];
    two(spring.a, spring.b);
    spring.a_at = random.point();
    spring.b_at = random.point();
    spring.stiffness = random.between(0, 50);
    spring.length = random.between(0, 1);
    spring.damping = random.between(0, 5);
  }
  for (int i = 0; i < scene.bodies && scene.joint_springs < Size::joint_springs; ++i) {
    if (coordinates(scene.body[i].joint) != 1) continue;
    auto& spring = scene.joint_spring[scene.joint_springs++];
    spring = {i, random.between(0, 50), random.between(-1, 1), random.between(0, 5)};
  }
  scene.loads = 2;
  for (int l = 0; l < scene.loads; ++l) {
    auto& load = scene.load[l];
    load.body = random.below(scene.bodies);
    load.at = random.point();
    load.force = {random.between(-20, 20), random.between(-20, 20)};
    load.torque = random.between(-5, 5);
    load.input = l == 0 ? 1 : none;
  }
  m.state.start = random.between(-1, 1);
  m.state.steps = random.below(100);
  m.state.dt = 0x1p-7;
  for (int j = 0; j < coordinates(scene); ++j) {
    m.state.q[j] = random.between(-2, 2);
    m.state.v[j] = random.between(-3, 3);
  }
  for (auto& in : m.inputs.input) in = {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
  return m;
}

/// Draws until the second formulation finds the constraints independent in every sign pattern and no pattern near a
/// tie. Pivots lose at most 4 digits then, and contact forces have signs.
Mechanism draw_sound(Random& random, double most_mu, Instant& truth) {
  for (int tries = 0; tries < 10000; ++tries) {
    const Mechanism m = draw(random, most_mu);
    EXPECT_EQ(defects(m.scene).count, 0);
    const int constraints = contacts(m.scene) + 2 * m.scene.pins + m.scene.drives;
    if (constraints > coordinates(m.scene)) continue;
    truth = solve(m.scene, m.state, m.inputs);
    bool slides = true;  // a guide that is at rest, as some are by their structure, is refused: see step.cpp
    for (const Real slip : truth.slip) slides = slides && std::fabs(slip) > 1e-6L;
    if (slides && truth.condition > 1e-4L && truth.margin > 1e-6L) return m;
  }
  ADD_FAILURE() << "no sound mechanism in 10000";
  return Mechanism();
}

/// Compares groups of numbers and keeps the worst.
struct Comparison {
  double worst = 0;
  /// max |ours - true| over max |true|.
  template <class Ours, class True>
  void group(const char* what, const Ours& ours, const True& exact) {
    Real size = 0, miss = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      size = std::fmax(size, std::fabs(exact[k]));
      miss = std::fmax(miss, std::fabs(Real{ours[k]} - exact[k]));
    }
    compare(what, miss, size);
  }
  void number(const char* what, double ours, Real exact, Real size) { compare(what, std::fabs(ours - exact), size); }

  void compare(const char* what, Real miss, Real size) {
    const double ratio = size > 0 ? static_cast<double>(miss / size) : 0;
    // Relative to the group's largest; the project's bar. Measured: 4e-14 at worst; a range of pivots of 1e4 turns the
    // 1e-15 of the kernel's rows into 1e-11.
    EXPECT_LT(ratio, 1e-10) << what;
    worst = std::fmax(worst, ratio);
  }
};

/// A stepper that takes any drift: the poses here are far off their constraints.
Stepper stepper_for(const Mechanism& m) {
  Stepper stepper(m.scene);
  stepper.drift_limit = std::numeric_limits<double>::infinity();
  return stepper;
}

void expect_agreement(const Stepper& stepper, const Mechanism& m, const Instant& truth, Comparison& comparison) {
  Stepper::Reaction r;
  slideway::test::litter_stack();
  const Report report = stepper.reaction(m.state, m.inputs, r);
  ASSERT_EQ(report.status, Status::ok) << sentence(report.status);
  EXPECT_NE(report.uniqueness, slideway::Uniqueness::refuted);
  comparison.group("q''", r.acceleration, truth.acceleration);
  comparison.group("slip", r.slip, truth.slip);
  Real force = 0;  // forces of the mechanism as a whole: a small one is a difference of large ones
  for (const Real f : truth.lambda) force = std::fmax(force, std::fabs(f));
  for (const Real f : truth.drive) force = std::fmax(force, std::fabs(f));
  for (std::size_t c = 0; c < truth.lambda.size(); ++c)
    comparison.number("lambda", r.lambda[c], truth.lambda[c], force);
  for (std::size_t g = 0; g < truth.friction.size(); ++g) {
    comparison.number("friction", r.friction[g], truth.friction[g], force);
  }
  for (std::size_t d = 0; d < truth.drive.size(); ++d) comparison.number("drive", r.drive[d], truth.drive[d], force);
  for (std::size_t p = 0; p < truth.pin.size(); ++p) {
    comparison.number("pin", r.pin[p].x, truth.pin[p].x, force);
    comparison.number("pin", r.pin[p].y, truth.pin[p].y, force);
  }
  const Real power = std::fabs(truth.work) + std::fabs(truth.dissipated) + std::fabs(truth.constraint_work);
  comparison.number("work", r.power.work, truth.work, power);
  comparison.number("dissipated", r.power.dissipated, truth.dissipated, power);
  comparison.number("constraint work", r.power.constraint_work, truth.constraint_work, power);
  comparison.number("energy rate", r.power.work - r.power.dissipated + r.power.constraint_work, truth.energy_rate,
                    power);
  comparison.number("drift", r.drift_position, truth.drift_position, truth.drift_position);
  comparison.number("drift rate", r.drift_velocity, truth.drift_velocity, truth.drift_velocity);
  comparison.number("kinetic energy", stepper.kinetic_energy(m.state), truth.kinetic, truth.kinetic);
  comparison.number("potential energy", stepper.potential_energy(m.state), truth.potential,
                    truth.kinetic + std::fabs(truth.potential));
}

TEST(Dynamics, AccelerationsForcesAndEnergiesOfRandomMechanismsAreRight) {
  Comparison comparison;
  int joints[4] = {}, laws[4] = {}, frictionless = 0, pairs = 0, pins = 0, moving_rails = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Instant truth;
    Mechanism m = draw_sound(random, 0.3, truth);
    for (int tries = 0; truth.solutions != 1 && tries < 100; ++tries) m = draw_sound(random, 0.3, truth);
    ASSERT_EQ(truth.solutions, 1);
    expect_agreement(stepper_for(m), m, truth, comparison);
    if (HasFatalFailure()) return;
    for (int i = 0; i < m.scene.bodies; ++i) ++joints[static_cast<int>(m.scene.body[i].joint)];
    for (int d = 0; d < m.scene.drives; ++d) ++laws[static_cast<int>(m.scene.drive[d].law)];
    pins += m.scene.pins;
    for (int g = 0; g < m.scene.guides; ++g) {
      frictionless += m.scene.guide[g].mu == 0 ? 1 : 0;
      pairs += m.scene.guide[g].contacts == 2 ? 1 : 0;
      moving_rails += m.scene.guide[g].rail != ground ? 1 : 0;
    }
  }
  // The sample has what it is meant to have.
  for (const int count : joints) EXPECT_GE(count, 30);
  for (const int count : laws) EXPECT_GE(count, 5);
  EXPECT_GE(frictionless, 10);
  EXPECT_GE(pairs, 10);
  EXPECT_GE(pins, 5);
  EXPECT_GE(moving_rails, 30);
  RecordProperty("worst", testing::PrintToString(comparison.worst));
}

TEST(Dynamics, AsManySolutionsAsSignPatternsHold) {
  int seen[3] = {};
  Comparison comparison;
  for (unsigned seed = 1; seed <= 80; ++seed) {
    SCOPED_TRACE(seed);
    Random random(1000 + seed);
    Instant truth;
    const Mechanism m = draw_sound(random, 3, truth);
    const Stepper stepper = stepper_for(m);
    ++seen[std::min(truth.solutions, 2)];
    if (truth.solutions == 1) {
      expect_agreement(stepper, m, truth, comparison);
    } else {
      Stepper::Reaction r;
      slideway::test::litter_stack();
      const Status status = stepper.reaction(m.state, m.inputs, r).status;
      EXPECT_EQ(status, truth.solutions == 0 ? Status::no_solution : Status::not_unique)
          << truth.solutions << " solutions, " << name(status);
    }
  }
  // The sample has what it is meant to have.
  for (const int count : seen) EXPECT_GE(count, 10);
  RecordProperty("none", seen[0]);
  RecordProperty("one", seen[1]);
  RecordProperty("several", seen[2]);
  RecordProperty("worst", testing::PrintToString(comparison.worst));
}

// --- kinematics alone ------------------------------------------------------------------------------------------------

/// f'(0) and f''(0) by central differences of order 6, step h = 2e-3: truncation h^6 f(8) / 560, 1e-13 for motions of
/// 5 rad/s; rounding 1e-19 / h^2 times |f|, 3e-13 for |f| = 10.
template <class F>
std::array<Real, 2> derivatives(F f) {
  const Real h = 2e-3L;
  const Real f0 = f(Real{0});
  Real first = 0, second = -f0 * 49 / 18;
  const Real a[3] = {3.0L / 4, -3.0L / 20, 1.0L / 60}, b[3] = {3.0L / 2, -3.0L / 20, 1.0L / 90};
  for (int k = 1; k <= 3; ++k) {
    const Real plus = f(k * h), minus = f(-k * h);
    first += a[k - 1] * (plus - minus);
    second += b[k - 1] * (plus + minus);
  }
  return {first / h, second / (h * h)};
}

TEST(Kinematics, ContactsPinsAndTheirRowsAreTheDerivativesOfTheirPlaces) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Mechanism m = draw(random, 0.3);
    const Stepper stepper(m.scene);
    const auto& table = stepper.source.tables;
    double prescribed[Size::coordinates];  // accelerations of the driven coordinates; the others have none
    for (int j = 0; j < Size::coordinates; ++j) {
      prescribed[j] = random.between(-3, 3);
      if (j >= table.coordinates || table.drive_of[j] == none) prescribed[j] = 0;
    }
    slideway::Kinematics<Size> k;
    kinematics(stepper.source, m.state.q, m.state.v, prescribed, k);

    const auto poses_at = [&](Real t) {
      Real q[Size::coordinates];
      for (int j = 0; j < Size::coordinates; ++j) q[j] = m.state.q[j] + t * (m.state.v[j] + t * prescribed[j] / 2);
      return place(m.scene, q);
    };
    const auto moved = [&](int coordinate, Real by) {
      Real q[Size::coordinates];
      for (int j = 0; j < Size::coordinates; ++j) q[j] = m.state.q[j] + (j == coordinate ? by : 0);
      return place(m.scene, q);
    };
    const auto agree = [&](const char* what, double ours, Real exact) {
      const double miss = static_cast<double>(std::fabs(ours - exact) / std::fmax(Real{1}, std::fabs(exact)));
      EXPECT_LT(miss, 1e-10) << what;  // m, m/s, m/s^2, beside values of 1 to 100; measured: 3e-13
      worst = std::fmax(worst, miss);
    };

    for (int i = 0; i < m.scene.bodies; ++i) {
      const Poses<Real> now = poses_at(0);
      agree("origin", k.origin[i].x, now[i].o.x);
      agree("origin", k.origin[i].y, now[i].o.y);
      agree("turn", k.turn[i].c, std::cos(now[i].angle));
      agree("turn", k.turn[i].s, std::sin(now[i].angle));
      const auto x = derivatives([&](Real t) { return poses_at(t)[i].o.x; });
      const auto y = derivatives([&](Real t) { return poses_at(t)[i].o.y; });
      const auto angle = derivatives([&](Real t) { return poses_at(t)[i].angle; });
      agree("velocity", k.velocity[i].x, x[0]);
      agree("velocity", k.velocity[i].y, y[0]);
      agree("known acceleration", k.known[i].x, x[1]);
      agree("known acceleration", k.known[i].y, y[1]);
      agree("rate", k.rate[i], angle[0]);
      agree("known angular acceleration", k.known_alpha[i], angle[1]);
    }
    for (int g = 0; g < m.scene.guides; ++g) {
      slideway::Sliding s;
      sliding(stepper.source, k, g, s);
      for (int c = 0; c < m.scene.guide[g].contacts; ++c) {
        const auto off = derivatives([&](Real t) { return on_line(m.scene, poses_at(t), g, c).y; });
        const auto along = derivatives([&](Real t) { return on_line(m.scene, poses_at(t), g, c).x; });
        agree("Phi", s.Phi[c], on_line(m.scene, poses_at(0), g, c).y);
        agree("Phi'", s.Phi_rate[c], off[0]);
        agree("gamma", s.gamma[c], off[1]);
        agree("slip", s.slip[c], along[0]);
      }
      double N[Size::coordinates] = {}, T[Size::coordinates] = {};
      set_row(stepper.source, k, table.guide[g], s.place, s.n, N);
      set_row(stepper.source, k, table.guide[g], s.place, s.t, T);
      for (int f = 0; f < table.free; ++f) {
        const int j = table.free_coordinate[f];
        agree("N", N[f], derivatives([&](Real by) { return on_line(m.scene, moved(j, by), g, 0).y; })[0]);
        agree("T", T[f], derivatives([&](Real by) { return on_line(m.scene, moved(j, by), g, 0).x; })[0]);
      }
    }
    for (int p = 0; p < m.scene.pins; ++p) {
      // The kernel's directions are the world's; the differences are taken in the frame of b and turned.
      slideway::Meeting at;
      meeting(stepper.source, k, p, at);
      const Real angle = pose_of(poses_at(0), m.scene.pin[p].b).angle;
      const auto x = derivatives([&](Real t) { return gap(m.scene, poses_at(t), p).x; });
      const auto y = derivatives([&](Real t) { return gap(m.scene, poses_at(t), p).y; });
      const Vec<Real> Phi = turned(gap(m.scene, poses_at(0), p), angle);
      const Vec<Real> rate = turned(Vec<Real>{x[0], y[0]}, angle), gamma = turned(Vec<Real>{x[1], y[1]}, angle);
      agree("pin's Phi", at.Phi.x, Phi.x);
      agree("pin's Phi", at.Phi.y, Phi.y);
      agree("pin's Phi'", at.rate.x, rate.x);
      agree("pin's Phi'", at.rate.y, rate.y);
      agree("pin's gamma", at.gamma.x, gamma.x);
      agree("pin's gamma", at.gamma.y, gamma.y);
      double row[Size::coordinates] = {};
      set_row(stepper.source, k, table.pin[p], at.place, {1, 0}, row);
      for (int f = 0; f < table.free; ++f) {
        const int j = table.free_coordinate[f];
        const Vec<Real> step{derivatives([&](Real by) { return gap(m.scene, moved(j, by), p).x; })[0],
                             derivatives([&](Real by) { return gap(m.scene, moved(j, by), p).y; })[0]};
        agree("pin's row", row[f], turned(step, angle).x);
      }
    }
  }
  RecordProperty("worst", testing::PrintToString(worst));
}

}  // namespace
