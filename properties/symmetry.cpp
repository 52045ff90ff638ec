// A motion is the same however it is written down.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <slideway/properties/rapidcheck.hpp>
#include <slideway/properties/symmetry.hpp>

namespace {

using namespace slideway;
using namespace slideway::properties;

constexpr Method methods[] = {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located, Method::moreau};
Method any_method() { return methods[*rc::gen::inRange(0, 5)]; }

RunStepper stepper_of(const MechanismScene& scene, Method method) {
  RunStepper stepper(scene);
  stepper.method = method;
  stepper.drift_limit =
      1e300;  // the limit of a driven angle's drift is a number a metre: units and it do not go together
  return stepper;
}

struct End {
  RunState state;
  Status status = Status::ok;
  int events = 0;
  Uniqueness uniqueness = Uniqueness::certified;
};

End run(const RunStepper& stepper, const RunState& start, double dt, int steps) {
  End end{start};
  for (int k = 0; k < steps && end.status == Status::ok; ++k) {
    const Report report = stepper.step(end.state, dt);
    end.status = report.status;
    end.events += report.events + report.unlocated_events;
    end.uniqueness = weaker(end.uniqueness, report.uniqueness);
  }
  return end;
}

constexpr double dt = 0x1p-10;
constexpr int steps = 4;

bool same_bits(const RunState& a, const RunState& b, int coordinates) {
  for (int j = 0; j < coordinates; ++j) {
    if (a.q[j] != b.q[j] || a.v[j] != b.v[j]) return false;
  }
  return true;
}

/// Are all contact forces on one face, or all nothing? One that is zero among others is on neither, and takes part in
/// the roundings by the column of A+.
bool have_faces(const RunStepper& stepper, const RunState& state) {
  RunStepper::Reaction r;
  if (stepper.reaction(state, {}, r).status != Status::ok) return false;
  double largest = 0, least = 1e300;
  for (int c = 0; c < stepper.source.tables.contacts; ++c) {
    largest = std::fmax(largest, std::fabs(r.lambda[c]));
    least = std::fmin(least, std::fabs(r.lambda[c]));
  }
  return least > 1e-9 * largest || largest == 0;
}

/// Not one bit differs. Where forces are a choice, or one of several, the choice may.
void hold_bits(const MechanismScene& scene, const Seen& seen, Method method) {
  const RunStepper one = stepper_of(scene, method), other = stepper_of(seen.scene, method);
  const End a = run(one, one.start(), dt, steps), b = run(other, seen.state(one.start()), dt * seen.time, steps);
  RC_PRE(a.uniqueness < Uniqueness::motion_only);
  RC_PRE(have_faces(one, one.start()) && have_faces(one, a.state));
  RC_ASSERT(a.status == b.status);
  RC_ASSERT(same_bits(seen.state(a.state), b.state, other.source.tables.coordinates));
  for (int g = 0; g < seen.scene.guides; ++g) RC_ASSERT(seen.state(a.state).mode[g] == b.state.mode[g]);
}

double distance(const RunState& a, const RunState& b, int coordinates) {
  double most = 0;
  for (int j = 0; j < coordinates; ++j) {
    most = std::fmax(most, std::fabs(a.q[j] - b.q[j]));
    most = std::fmax(most, std::fabs(a.v[j] - b.v[j]));
  }
  return most;
}

/// Not more than rounding differs: what changes of 64 roundings in q and v make of it, of either sign.
void hold_rounding(const MechanismScene& scene, const Seen& seen, Method method) {
  const RunStepper one = stepper_of(scene, method), other = stepper_of(seen.scene, method);
  const int n = one.source.tables.coordinates;
  const End a = run(one, one.start(), dt, steps), b = run(other, seen.state(one.start()), dt * seen.time, steps);
  RC_PRE(a.status == Status::ok && a.uniqueness < Uniqueness::motion_only);
  double size = 1, change = 0;
  for (int j = 0; j < n; ++j) size = std::fmax(size, std::fmax(std::fabs(a.state.q[j]), std::fabs(a.state.v[j])));
  for (int pattern = 0; pattern < 4; ++pattern) {
    RunState moved = one.start();
    for (int j = 0; j < n; ++j) {
      const double by = ((j + pattern) % 2 == 0 ? 1 : -1) * 64 * 0x1p-52 * size;
      moved.q[j] += by;
      if (moved.v[j] != 0) moved.v[j] += pattern < 2 ? by : -by;
    }
    const End c = run(one, moved, dt, steps);
    RC_PRE(c.status == Status::ok && c.events == a.events);  // else an event is within rounding
    change = std::fmax(change, distance(a.state, c.state, n));
  }
  RC_PRE(change < 1e-6);
  RC_ASSERT(b.status == Status::ok);
  RC_ASSERT(distance(seen.state(a.state), b.state, n) <= 4 * change + 1e-12 * size);
}

RC_GTEST_PROP(SymmetryProperty, AMirrorChangesNoBit, (const Mechanism& mechanism)) {
  hold_bits(mechanism.scene, mirrored(mechanism.scene), any_method());
}

RC_GTEST_PROP(SymmetryProperty, ReversedGuidesChangeNoBit, (const Mechanism& mechanism)) {
  hold_bits(mechanism.scene, with_guides_reversed(mechanism.scene), any_method());
}

RC_GTEST_PROP(SymmetryProperty, UnitsByPowersOfTwoChangeNoBit, (const Mechanism& mechanism)) {
  const int length = *rc::gen::inRange(-8, 9), mass = *rc::gen::inRange(-8, 9), time = *rc::gen::inRange(-8, 9);
  hold_bits(mechanism.scene, in_units(mechanism.scene, length, mass, time), any_method());
}

/// Their contacts have HLCPs of their own (structure.hpp, parts), and what is found in one decides nothing in the
/// other.
RC_GTEST_PROP(SymmetryProperty, AnotherMechanismBesideItChangesNoBit, (const Mechanism& mechanism)) {
  hold_bits(mechanism.scene, doubled(mechanism.scene), any_method());
}

RC_GTEST_PROP(SymmetryProperty, ATurnedWorldMovesTheSame, (const Mechanism& mechanism)) {
  hold_rounding(mechanism.scene, turned(mechanism.scene), any_method());
}

RC_GTEST_PROP(SymmetryProperty, TheOrderOfTheListsDoesNotMatter, (const Mechanism& mechanism)) {
  std::vector<int> order(static_cast<std::size_t>(mechanism.scene.guides));
  std::iota(order.rbegin(), order.rend(), 0);
  hold_rounding(mechanism.scene, reordered(mechanism.scene, order), any_method());
}

/// Where nothing depends on the time, neither do the steps; events are located to roundings of it.
RC_GTEST_PROP(SymmetryProperty, TimeShiftedChangesNoBit, (const Mechanism& mechanism)) {
  RC_PRE(mechanism.scene.drives == 0);
  const RunStepper stepper = stepper_of(mechanism.scene, any_method());
  RunState later = stepper.start();
  later.start = 1024;
  const End a = run(stepper, stepper.start(), dt, steps), b = run(stepper, later, dt, steps);
  if (a.events + b.events > 0) return;
  RC_ASSERT(a.status == b.status);
  RC_ASSERT(same_bits(a.state, b.state, stepper.source.tables.coordinates));
}

/// The signs tried first say how long the solver looks, not what it finds.
RC_GTEST_PROP(SymmetryProperty, TheSignsTriedFirstChangeNoBit, (const Mechanism& mechanism)) {
  const RunStepper stepper = stepper_of(mechanism.scene, any_method());
  RunState state = stepper.start();
  RC_PRE(stepper.step(state, dt).status == Status::ok);
  RunStepper::Reaction r;
  RC_PRE(stepper.reaction(state, {}, r).status == Status::ok);
  double largest = 0, least = 1e300;
  for (int c = 0; c < stepper.source.tables.contacts; ++c) {
    largest = std::fmax(largest, std::fabs(r.lambda[c]));
    least = std::fmin(least, std::fabs(r.lambda[c]));
  }
  RC_PRE(least > 1e-9 * largest && least > 1e-6);  // rounding has no face of its own: it keeps the one before
  RunState other = state;
  for (int c = 0; c < stepper.source.tables.contacts; ++c) {
    if (*rc::gen::arbitrary<bool>()) other.sign[c] = static_cast<signed char>(other.sign[c] < 0 ? 1 : -1);
  }
  const End a = run(stepper, state, dt, 1), b = run(stepper, other, dt, 1);
  RC_PRE(a.uniqueness < Uniqueness::motion_only);
  RC_ASSERT(a.status == b.status);
  RC_ASSERT(same_bits(a.state, b.state, stepper.source.tables.coordinates));
}

}  // namespace
