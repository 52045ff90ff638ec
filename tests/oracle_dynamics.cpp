// The oracle's mechanics: every row, force and frame against second-order differentiation of their definitions in
// scene.hpp, drives against their laws, whole mechanisms against closed forms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <slideway/oracle/trajectory.hpp>
#include <support/definitions.hpp>

namespace {

using slideway::EventKind;
using namespace slideway::oracle;
using namespace slideway::test;
using slideway::ground;
using slideway::Joint;
using slideway::Law;

// ---- A mechanism with every kind of item, at random poses that need not satisfy anything

class Random {
 public:
  Real number() { return ratio(static_cast<int>(engine_() % 2001u) - 1000, 700); }
  RealVec vec() { return {number(), number()}; }
  std::vector<Real> numbers(std::size_t n) {
    std::vector<Real> all(n);
    for (Real& x : all) x = number();
    return all;
  }

 private:
  std::mt19937 engine_{20241};
};

RealModel everything(Random& random) {
  RealModel m{random.vec(), Real(20), Real(100), {}, {}, {}, {}, {}, {}, {}, {}};
  const auto body = [&](int parent, Joint joint) {
    const Real angle = random.number();
    m.body.push_back({parent, joint, random.vec(), {cos(angle), sin(angle)}, angle, Real(1), random.vec(), Real(1)});
    for (int k = 0; k < slideway::coordinates(joint); ++k) {
      m.start.q.push_back(random.number());
      m.start.v.push_back(random.number());
    }
  };
  for (const Joint joint : {Joint::revolute, Joint::prismatic, Joint::planar, Joint::fixed}) body(ground, joint);
  for (const Joint joint : {Joint::fixed, Joint::planar, Joint::revolute, Joint::prismatic}) {
    body(static_cast<int>(m.body.size()) - 2, joint);
  }
  for (const auto& [slider, rail] : {std::pair{2, ground}, {5, 0}, {1, 7}}) {
    const Real angle = random.number();
    m.guide.push_back({slider,
                       rail,
                       random.vec(),
                       {cos(angle), sin(angle)},
                       {random.vec(), random.vec()},
                       Real(0),
                       Real(0),
                       Real(0),
                       Real(0)});
  }
  m.pin = {{6, ground, random.vec(), random.vec()}, {3, 5, random.vec(), random.vec()}};
  m.spring = {{4, ground, random.vec(), random.vec(), Real(3), Real(1), Real(0)},
              {2, 7, random.vec(), random.vec(), Real(5), Real(2), Real(0)}};
  m.joint_spring = {{0, Real(2), random.number(), Real(0)}, {7, Real(4), random.number(), Real(0)}};
  m.load = {{6, random.vec(), random.vec(), random.number()}};
  return m;
}

/// d f / d position, one direction at a time.
template <class F>
std::vector<Real> gradient(const RealModel& model, const std::vector<Real>& position, const F& f) {
  std::vector<Real> slopes;
  for (std::size_t i = 0; i < position.size(); ++i) {
    std::vector<Real> direction(position.size(), Real(0));
    direction[i] = 1;
    slopes.push_back(f(frames_along(model, position, direction)).d);
  }
  return slopes;
}

struct RowCheck {
  Agreement value, gradient, turning;
  void compare(const Mechanism<Real>::Row& row, const Jet& jet, const std::vector<Real>& gradient_wanted) {
    value.compare(row.value[0], jet.f, Real(1 + abs(jet.f)));
    value.compare(row.speed[0], jet.d, Real(1 + abs(jet.d)));
    turning.compare(row.turning[0], jet.dd, Real(1 + abs(jet.dd)));
    std::vector<Real> got(gradient_wanted.size(), Real(0));
    for (std::size_t j = 0; j < 3; ++j) {
      if (row.a != ground) got[static_cast<std::size_t>(3 * row.a) + j] += row.on_a[j][0];
      if (row.b != ground) got[static_cast<std::size_t>(3 * row.b) + j] += row.on_b[j][0];
    }
    for (std::size_t i = 0; i < got.size(); ++i) gradient.compare(got[i], gradient_wanted[i], Real(1));
  }
};

TEST(Dynamics, RowsAreTheDefinitionsAndTheirDerivatives) {
  Random random;
  RowCheck check;
  for (int trial = 0; trial < 5; ++trial) {
    const RealModel model = everything(random);
    Dynamics<Real> dynamics(model, 4);
    const Motion<Real> motion{Real(0), random.numbers(24), random.numbers(24)};
    dynamics.begin(motion);
    const Values along = values(model, frames_along(model, motion.position, motion.velocity));
    std::vector<Values> slopes;  // along each body coordinate
    for (std::size_t i = 0; i < 24; ++i) {
      std::vector<Real> direction(24, Real(0));
      direction[i] = 1;
      slopes.push_back(values(model, frames_along(model, motion.position, direction)));
    }
    const auto all = [&](const std::vector<Mechanism<Real>::Row>& rows, std::vector<Jet> Values::*kind) {
      ASSERT_EQ(rows.size(), (along.*kind).size());
      for (std::size_t r = 0; r < rows.size(); ++r) {
        std::vector<Real> gradient;
        for (const Values& slope : slopes) gradient.push_back((slope.*kind)[r].d);
        check.compare(rows[r], (along.*kind)[r], gradient);
      }
    };
    all(dynamics.mechanism.joint, &Values::joint);
    all(dynamics.mechanism.coordinate, &Values::coordinate);
    all(dynamics.mechanism.normal, &Values::normal);
    all(dynamics.mechanism.tangential, &Values::tangential);
    all(dynamics.mechanism.pin, &Values::pin);
  }
  check.value.hold("value", 45);
  check.gradient.hold("gradient", 45);
  check.turning.hold("turning", 45);
}

/// A damper of the strength c_i = stiffness_i: half the rate of (the potential of what is stretched), by direction, so
/// the gradient of sum c_i (stretch_i)' direction_i is what the dampers add to the forces.
std::vector<Real> damper_forces(const RealModel& model, const Motion<Real>& motion) {
  std::vector<Real> forces(motion.position.size(), Real(0));
  const auto add = [&](const auto& stretch, const Real& damping) {
    const Real speed = stretch(frames_along(model, motion.position, motion.velocity)).d;
    const std::vector<Real> slope = gradient(model, motion.position, stretch);
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= damping * speed * slope[i];
  };
  for (const auto& s : model.spring) {
    const auto length = [&](const Frames& frames) {
      const Point gap = frame_of(frames, s.a).place(s.a_at) - frame_of(frames, s.b).place(s.b_at);
      return root(dot(gap, gap));
    };
    add(length, s.damping);
  }
  for (const auto& s : model.joint_spring) {  // body 0 revolute, body 7 prismatic: see everything()
    add(
        [&](const Frames& frames) {
          return s.body == 0 ? values(model, frames).coordinate[0] : values(model, frames).coordinate.back();
        },
        s.damping);
  }
  return forces;
}

TEST(Dynamics, ForcesAreTheSlopeOfThePotentialAndDampersOpposeTheStretching) {
  Random random;
  Agreement forces, dampers, energies;
  for (int trial = 0; trial < 3; ++trial) {
    RealModel model = everything(random);
    const Motion<Real> motion{Real(0), random.numbers(24), random.numbers(24)};
    std::vector<Real> wanted = gradient(model, motion.position, [&](const Frames& f) { return potential(model, f); });
    const auto compare = [&](Agreement& agreement) {
      Dynamics<Real> dynamics(model, 4);
      dynamics.begin(motion);
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        agreement.compare(dynamics.mechanism.force[i][0], Real(-wanted[i]), Real(1 + abs(wanted[i])));
      }
      Real power(0), potential_now(0);  // the oracle counts the work of loads apart from the potential
      const std::vector<Real> damping = damper_forces(model, motion);
      for (std::size_t i = 0; i < wanted.size(); ++i) power -= damping[i] * motion.velocity[i];
      energies.compare(dynamics.mechanism.damper_power[0], power, Real(1 + power));
      RealModel unloaded = model;
      unloaded.load.clear();
      const Frames frames = frames_along(model, motion.position, motion.velocity);
      const Jet stored = potential(unloaded, frames), loaded = potential(model, frames);
      energies.compare(dynamics.mechanism.potential[0], stored.f, Real(1 + abs(stored.f)));
      energies.compare(dynamics.mechanism.load_power[0], Real(stored.d - loaded.d), Real(1 + abs(stored.d)));
    };
    compare(forces);
    for (auto& s : model.spring) s.damping = random.number() + 2;
    for (auto& s : model.joint_spring) s.damping = random.number() + 2;
    const std::vector<Real> damping = damper_forces(model, motion);
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] -= damping[i];
    compare(dampers);
  }
  forces.hold("forces", 45);
  dampers.hold("dampers", 45);
  energies.hold("energies", 45);
}

TEST(Dynamics, PlacesBodiesWhereTheirCoordinatesSay) {
  Random random;
  Agreement all;
  for (int trial = 0; trial < 5; ++trial) {
    const RealModel model = everything(random);
    const Motion<Real> motion = Dynamics<Real>(model, 4).place(Real(3), model.start.q, model.start.v);
    EXPECT_EQ(motion.t, 3);
    const Frames frames = frames_of_joints(model);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Point centre = frames[i].place(model.body[i].com);
      const std::array<Jet, 3> wanted = {centre.x, centre.y, frames[i].angle};
      for (std::size_t k = 0; k < 3; ++k) {
        all.compare(motion.position[3 * i + k], wanted[k].f, Real(1 + abs(wanted[k].f)));
        all.compare(motion.velocity[3 * i + k], wanted[k].d, Real(1 + abs(wanted[k].d)));
      }
    }
  }
  all.hold("place", 45);
}

// ---- Newton's law and the drives' laws, whatever the mechanism

/// M a - forces - sum of multipliers times independently found gradients, and the second derivative of every row.
TEST(Dynamics, SolutionSatisfiesTheEquationsOfMotion) {
  Random random;
  Agreement newton, constraints;
  RealModel model = everything(random);
  model.pin.clear();
  model.guide.resize(2);  // 11 coordinates less 4 contacts less 2 drives
  for (auto& guide : model.guide) guide.mu = guide.mu_static = ratio(1, 5);
  model.guide[1].contact.pop_back();
  model.drive = {{0, 0, Law::harmonic, {ratio(1, 3), ratio(2, 3), Real(5), ratio(1, 7)}},
                 {7, 0, Law::polynomial, {Real(1), Real(2), Real(-1), ratio(1, 2)}}};
  Dynamics<Real> dynamics(model, 6);
  const Motion<Real> motion{ratio(3, 10), random.numbers(24), random.numbers(24)};
  dynamics.begin(motion);
  const Mode mode{{1, -1}, {1, -1, -1}};
  const Coefficients<Real> mu = {ratio(1, 5), ratio(1, 5)};
  ASSERT_TRUE(dynamics.solve(mode, mu));

  std::vector<Real> forces = gradient(model, motion.position, [&](const Frames& f) { return potential(model, f); });
  for (Real& f : forces) f = -f;
  const auto act = [&](const auto& row, const Real& multiplier) {
    const std::vector<Real> slope = gradient(model, motion.position, row);
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += multiplier * slope[i];
  };
  // A row's second derivative: turning along the velocity, and the gradient times the accelerations.
  const auto require = [&](const auto& row, const Real& value, const Real& rate, const Real& second, bool gains) {
    const Jet along = row(frames_along(model, motion.position, motion.velocity));
    const std::vector<Real> slope = gradient(model, motion.position, row);
    Real total = along.dd - second, scale(1);
    for (std::size_t i = 0; i < slope.size(); ++i) {
      total += slope[i] * dynamics.unknown(static_cast<int>(i), 0);
      scale += abs(slope[i] * dynamics.unknown(static_cast<int>(i), 0));
    }
    if (gains) total += model.alpha * (along.d - rate) + model.beta * (along.f - value);
    constraints.compare(total, Real(0), scale);
  };
  const auto row_of = [&](std::vector<Jet> Values::*kind, std::size_t r) {
    return [&model, kind, r](const Frames& frames) { return (values(model, frames).*kind)[r]; };
  };
  int unknown = 24;
  for (std::size_t r = 0; r < dynamics.mechanism.joint.size(); ++r, ++unknown) {
    act(row_of(&Values::joint, r), dynamics.unknown(unknown, 0));
    require(row_of(&Values::joint, r), 0, 0, 0, false);
  }
  const Real t = motion.t, phase = 5 * t + ratio(1, 7);
  const auto harmonic = row_of(&Values::coordinate, 0);
  const auto polynomial = row_of(&Values::coordinate, dynamics.mechanism.coordinate.size() - 1);
  require(harmonic, ratio(1, 3) + ratio(2, 3) * sin(phase), ratio(10, 3) * cos(phase), -ratio(50, 3) * sin(phase),
          true);
  require(polynomial, 1 + 2 * t - t * t + t * t * t / 2, 2 - 2 * t + ratio(3, 2) * t * t, -2 + 3 * t, true);
  act(harmonic, dynamics.unknown(dynamics.unknown_of_drive(0), 0));
  act(polynomial, dynamics.unknown(dynamics.unknown_of_drive(1), 0));
  for (std::size_t c = 0; c < 3; ++c) {
    const Real lambda = dynamics.lambda(static_cast<int>(c), 0);
    const int slip = c < 2 ? 1 : -1, sign = c == 0 ? 1 : -1;
    act(row_of(&Values::normal, c), lambda);
    act(row_of(&Values::tangential, c), Real(-ratio(1, 5) * slip * sign * lambda));
    require(row_of(&Values::normal, c), 0, 0, 0, true);
  }
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Real inertia = dynamics.mechanism.mass(static_cast<int>(i)) * dynamics.unknown(static_cast<int>(i), 0);
    newton.compare(inertia, forces[i], Real(1 + abs(inertia)));
  }
  newton.hold("newton", 45);
  constraints.hold("constraints", 45);
}

// ---- The paper's crank-rocker, from the doubles of its scene

/// The crank-rocker's closed form for any lengths and masses.
struct CrankRocker {
  Real th1, rate, acceleration, r, r_rate, lambda, torque;

  CrankRocker(const RealModel& m, const Real& t) {
    const auto &rocker = m.body[0], &crank = m.body[1], &block = m.body[2];
    const Real g = -m.gravity.y, omega = m.drive[0].c[1], a = m.drive[0].c[0] + omega * t, length = block.at.x;
    const RealVec arm{length * cos(a), length * sin(a)}, tip{crank.at.x + arm.x, crank.at.y + arm.y};
    const RealVec speed{-omega * arm.y, omega * arm.x}, pull{-omega * omega * arm.x, -omega * omega * arm.y};
    r = sqrt(Real(tip.x * tip.x + tip.y * tip.y));
    const RealVec along{tip.x / r, tip.y / r};
    const auto ahead = [&](const RealVec& v) { return Real(along.x * v.x + along.y * v.y); };
    const auto across = [&](const RealVec& v) { return Real(along.x * v.y - along.y * v.x); };
    th1 = atan2(tip.y, tip.x);
    r_rate = ahead(speed);
    rate = across(speed) / r;
    acceleration = (across(pull) - 2 * r_rate * rate) / r;
    const Real inertia = rocker.inertia + rocker.mass * rocker.com.x * rocker.com.x;
    lambda = -(inertia * acceleration + rocker.mass * g * rocker.com.x * along.x) / r;
    const Real friction = m.guide[0].mu * abs(lambda) * (r_rate > 0 ? -1 : 1);
    const RealVec force{-along.y * lambda + along.x * friction, along.x * lambda + along.y * friction};
    torque = g * cos(a) * (crank.mass * crank.com.x + block.mass * length) - (arm.x * force.y - arm.y * force.x);
  }
};

Trajectory<Real> run(const RealModel& model, const std::vector<Real>& times) {
  return Integrator<Real>(model, {}).run(times.back(), times);
}

void expect_closed_form(const std::string& scene) {
  const RealModel model = shipped(scene);
  const Real omega = model.drive[0].c[1];
  std::vector<Real> times = {0, ratio(1, 4), pi / (2 * omega), 1, ratio(3, 2), 3 * pi / (2 * omega), 2, 3, 4};
  const auto trajectory = run(model, times);
  ASSERT_EQ(trajectory.samples.size(), times.size());
  std::vector<Real> got[7], wanted[7];
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Instant<Real>& now = trajectory.samples[i];
    const CrankRocker truth(model, times[i]);
    const Real length = model.body[2].at.x,
               r = length * cos(Real(now.q[1] - now.q[0])) + model.body[1].at.y * sin(now.q[0]);
    const Real had[] = {now.q[0], now.v[0], now.acceleration[0], r, now.slip[0], now.lambda[0], now.drive[0]};
    const Real want[] = {truth.th1, truth.rate, truth.acceleration, truth.r, truth.r_rate, truth.lambda, truth.torque};
    for (std::size_t k = 0; k < 7; ++k) {
      got[k].push_back(had[k]);
      wanted[k].push_back(want[k]);
    }
  }
  const char* names[] = {"th1", "th1_rate", "th1_acceleration", "r", "r_rate", "lambda", "torque"};
  for (std::size_t k = 0; k < 7; ++k) {
    Agreement all;
    all.compare_all(got[k], wanted[k]);
    all.hold(scene + "_" + names[k], 30);
  }
  Agreement reversals;
  ASSERT_EQ(trajectory.events.size(), 8u);  // slip and force at pi/6 and pi/2, and again a turn later
  for (int k = 0; k < 8; ++k) {
    const auto& event = trajectory.events[static_cast<std::size_t>(k)];
    EXPECT_EQ(event.kind, k % 2 == 0 ? EventKind::slip_reversal : EventKind::normal_reversal);
    reversals.compare(event.t, Real((2 * (k / 2) + 1) * pi / (2 * omega)));
  }
  reversals.hold(scene + "_reversals", 30);
}

TEST(CrankRockerTruth, ClosedFormIsMet) {
  expect_closed_form("crank_rocker");
  expect_closed_form("crank_rocker_weightless");
}

TEST(CrankRockerTruth, ThePublishedTableIsMet) {
  struct {
    double t, th1, rate, acceleration, r, r_rate, lambda0, torque0, lambda, torque;
  } const table[] = {
      {0, 1.1071487177940905, 0.6, 2.16, 1.1180339887498948, 1.3416407864998738, -10.303801240319031, 3.2256,
       -25.999801240319031, 15.496725216477138},
      {0.25, 1.3044287547592353, 0.91759296650973704, 0.66183297681420555, 1.3898340764362249, 0.78968656900757296,
       -2.5397102691519738, 1.213337511743847, -9.9716048368147953, 10.147299454776796},
      {1, 2.003890489830896, 0.69129910181581881, -1.726539370919448, 1.1794575058304844, -1.259043871915548,
       7.8071570469623096, -1.4665722132915669, 21.76975744862718, -11.373312489997641},
      {1.5, 1.7741110839566473, -2.6288967072596315, -9.5829389441008736, 0.52198647715712228, -0.60575074831103837,
       97.91251294521005, 48.740805885290572, 113.09148813832301, 54.745962966875702}};
  const auto heavy = run(shipped("crank_rocker"), {0, ratio(1, 4), 1, ratio(3, 2)});
  const auto light = run(shipped("crank_rocker_weightless"), {0, ratio(1, 4), 1, ratio(3, 2)});
  Agreement all;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& row = table[i];
    const Instant<Real>&h = heavy.samples[i], &l = light.samples[i];
    const Real r = cos(Real(h.q[1] - h.q[0])) / 2 + sin(h.q[0]);  // of the tip (cos q1 / 2, 1 + sin q1 / 2)
    const std::pair<Real, double> pairs[] = {{h.q[0], row.th1},
                                             {h.v[0], row.rate},
                                             {h.acceleration[0], row.acceleration},
                                             {r, row.r},
                                             {h.slip[0], row.r_rate},
                                             {l.lambda[0], row.lambda0},
                                             {l.drive[0], row.torque0},
                                             {h.lambda[0], row.lambda},
                                             {h.drive[0], row.torque}};
    for (const auto& [got, wanted] : pairs) all.compare(got, Real(wanted));
  }
  all.hold("table", 15);  // printed to 16 or 17 digits, some ending in zeros that are not printed
}

TEST(CrankRockerTruth, FrictionWorkOfATurn) {
  const RealModel light = shipped("crank_rocker_weightless"), heavy = shipped("crank_rocker");
  const Real turn = 2 * pi / 3, fifth = light.guide[0].mu * 5;
  const Real inertia = light.body[0].inertia + 4;  // 16/3 to a double; the work is proportional to it
  Agreement closed, printed;
  closed.compare(run(light, {turn}).samples[0].dissipated, Real(64 * pi / 15 * fifth * inertia / ratio(16, 3)));
  closed.hold("64_pi_15", 30);
  printed.compare(run(heavy, {turn}).samples[0].dissipated, Real("20.2566301180101689"));
  printed.compare(run(heavy, {turn}).samples[0].work, Real(Real("3.223942813665482") * 2 * pi));
  printed.hold("with_gravity", 15);
}

}  // namespace
