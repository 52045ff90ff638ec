// What must hold of every step of every mechanism by every method.
#include <cmath>
#include <cstring>
#include <limits>
#include <slideway/properties/rapidcheck.hpp>
#include <slideway/properties/step.hpp>

namespace {

using namespace slideway;
using namespace slideway::properties;

constexpr Method methods[] = {Method::euler,          Method::rk4,    Method::rk4_located,
                              Method::dop853_located, Method::moreau, Method::kinematic};

Method any_method() { return *rc::gen::elementOf(std::vector<Method>(std::begin(methods), std::end(methods))); }
/// Those that integrate, and know of rest.
Method any_integrating() { return methods[*rc::gen::inRange(0, 5)]; }

RunStepper stepper_of(const Mechanism& mechanism, Method method) {
  RunStepper stepper(mechanism.scene);
  stepper.method = method;
  return stepper;
}

/// Do the constraints leave any freedom? Where they do not, friction changes nothing, and all its forces are rounding.
bool is_movable(const RunStepper& stepper) {
  const auto& table = stepper.source.tables;
  return table.free > table.contacts + 2 * stepper.source.scene.pins;
}

/// At most `steps` steps, each held to its contract. The first that is refused is the last; false then.
bool run(const RunStepper& stepper, RunState& state, double dt, int steps, Report* last = nullptr) {
  for (int k = 0; k < steps; ++k) {
    RunState before;
    std::memcpy(&before, &state, sizeof state);
    const Report report = stepper.step(state, dt);
    if (last != nullptr) *last = report;
    const Violation violation = step_contract(stepper, before, state, report, dt);
    if (!violation.empty()) RC_FAIL(std::string(name(stepper.method)) + ": " + violation);
    if (report.status != Status::ok) return false;
  }
  return true;
}

void hold(const Violation& violation) {
  if (!violation.empty()) RC_FAIL(violation);
}

RC_GTEST_PROP(StepProperty, ObeysCoulombsLawAtTheStartAndAfter, (const Mechanism& mechanism)) {
  const Method method = any_integrating();
  const RunStepper stepper = stepper_of(mechanism, method);
  RunStepper forces = stepper;  // moreau's reactions are means over a step, of other slips
  if (method == Method::moreau) forces.method = Method::rk4_located;
  RunState state = stepper.start();
  hold(coulomb(forces, state));
  for (int k = 0; k < 4; ++k) {
    if (!run(stepper, state, 1e-3, 2)) break;
    hold(coulomb(forces, state));
  }
  RC_TAG(std::string(name(mechanism.stratum)), std::string(mechanism.assembled ? "assembled" : "not assembled"));
}

RC_GTEST_PROP(StepProperty, RefusesOrAdvancesWhateverItIsGiven, (const Mechanism& mechanism)) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const RunStepper stepper = stepper_of(mechanism, any_method());
  RunState state = stepper.start();
  const double dt = *rc::gen::element(nan, infinity, 0.0, -1e-3, 1e-300, 1e-9, 1e-3, 0.1, 1.0, 1e9);
  const int what = *rc::gen::inRange(0, 8),
            j = *rc::gen::inRange(0, std::max(1, static_cast<int>(stepper.source.tables.coordinates)));
  const double bad = *rc::gen::element(nan, infinity, -infinity, 1e300, -1e300, 1e-320);
  if (what == 0) state.q[j] = bad;
  if (what == 1) state.v[j] = bad;
  if (what == 2) state.start = bad;
  run(stepper, state, dt, 2);
}

/// Nothing but the state is remembered.
RC_GTEST_PROP(StepProperty, ACopyReplaysBitForBit, (const Mechanism& mechanism)) {
  const RunStepper stepper = stepper_of(mechanism, any_method());
  RunState state = stepper.start();
  run(stepper, state, 1e-3, *rc::gen::inRange(0, 4));
  RunState one = state, other = state;
  Report a, b;
  run(stepper, one, 1e-3, 3, &a);
  run(stepper_of(mechanism, stepper.method), other, 1e-3, 3, &b);
  RC_ASSERT(std::memcmp(&one, &other, sizeof one) == 0 || (one == other));
  RC_ASSERT(a.status == b.status && a.evaluations == b.evaluations && a.uniqueness == b.uniqueness);
}

/// final - initial = work - dissipated + constraint_work, but for what a step's truncation leaves: it shrinks with the
/// step, or is rounding. Where nothing jumps, and not at the speed of the gains.
RC_GTEST_PROP(StepProperty, TheEnergyBalanceCloses, (const Mechanism& mechanism)) {
  const Method method = *rc::gen::element(Method::rk4_located, Method::dop853_located, Method::rk4);
  const RunStepper stepper = stepper_of(mechanism, method);
  constexpr double duration = 0.02;
  double in_play = 1e-4;  // some N over what rounding moves
  const auto missed = [&](int steps) {
    RunState state = stepper.start();
    const auto energy = [&] { return stepper.kinetic_energy(state) + stepper.potential_energy(state); };
    const double before = energy();
    double balance = 0;
    for (int k = 0; k < steps; ++k) {
      const Report report = stepper.step(state, duration / steps);
      RC_PRE(report.status == Status::ok && report.unlocated_events == 0);
      balance += report.energy.work - report.energy.dissipated + report.energy.constraint_work;
      in_play = std::fmax(in_play, stepper.kinetic_energy(state) + std::fabs(energy()) + std::fabs(report.energy.work));
    }
    return std::fabs(energy() - before - balance);
  };
  RC_PRE(mechanism.assembled);
  const double coarse = missed(8), fine = missed(32);
  RC_ASSERT(fine <= 1e-12 * in_play || fine <= coarse / 16 || fine <= 1e-9 * in_play);
}

/// Every guide held, no force that can move anything: nothing moves, as far as it goes in 200 steps.
RC_GTEST_PROP(StepProperty, RestStaysRest, ()) {
  const Mechanism mechanism = *rc::gen::suchThat(rc::gen::arbitrary<Mechanism>(), [](const Mechanism& drawn) {
    return drawn.stratum == Stratum::on_kink && drawn.scene.drives == 0 && drawn.assembled && drawn.scene.guides > 0;
  });
  const RunStepper stepper = stepper_of(mechanism, any_integrating());
  RC_PRE(is_movable(stepper));
  RunState state = stepper.start();
  RunStepper asking = stepper;
  asking.method = Method::rk4;
  RunStepper::Reaction r;
  const Report report = asking.reaction(state, {}, r);
  RC_PRE(report.status == Status::ok && report.uniqueness != Uniqueness::refuted);
  double most = 0;
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) most = std::fmax(most, std::fabs(r.acceleration[j]));
  RC_PRE(most < 1e-12);
  const RunState start = state;
  // A step may be refused: as not unique, where both rest and slip hold as soon as forces are not exactly zero; as
  // inaccurate, where all forces are rounding beside a preload.
  RC_CLASSIFY(!run(stepper, state, 1e-3, 200), "refused");
  for (int j = 0; j < stepper.source.tables.coordinates; ++j)
    RC_ASSERT(std::fabs(state.q[j] - start.q[j]) < 1e-13 * (1 + std::fabs(start.q[j])));
}

/// A start beside the constraints returns to them as Phi'' + alpha Phi' + beta Phi = 0 does, critically damped.
RC_GTEST_PROP(StepProperty, ADisturbedConstraintReturnsWithinItsEnvelope, (const Mechanism& mechanism)) {
  RC_PRE(mechanism.assembled && mechanism.scene.guides + mechanism.scene.pins > 0);
  const RunStepper stepper =
      stepper_of(mechanism, *rc::gen::element(Method::rk4, Method::rk4_located, Method::dop853_located));
  RunState state = stepper.start(), calm = state;
  const int j = *rc::gen::inRange(0, static_cast<int>(stepper.source.tables.coordinates));
  constexpr double off = 1e-7;
  state.q[j] += off;
  Report disturbed = stepper.step(state, 1e-3), undisturbed = stepper.step(calm, 1e-3);
  const double position = disturbed.drift_position, velocity = disturbed.drift_velocity;
  RC_PRE(position > off / 100);
  double floor = 0, fastest = 0;  // of all turns together, rad/s
  for (int k = 1; k < 200; ++k) {
    disturbed = stepper.step(state, 1e-3);
    undisturbed = stepper.step(calm, 1e-3);
    RC_PRE(disturbed.status == Status::ok && undisturbed.status == Status::ok);
    floor = std::fmax(floor, undisturbed.drift_position);
    double turning = 0;
    for (int i = 0; i < stepper.source.tables.coordinates; ++i) {
      if (stepper.source.tables.motion[i] == Motion::turn) turning += std::fabs(state.v[i]);
    }
    fastest = std::fmax(fastest, turning);
    const double w = std::sqrt(mechanism.scene.beta), t = 1e-3 * k;
    const double envelope = std::exp(-w * t) * (position * (1 + w * t) + velocity * t);
    // What the method leaves of each step in both; the square of the disturbance, times curvatures of some 1/m; and 2 %
    // for rows that turn with what the disturbance does to the other coordinates.
    // A pin is missed in a frame that turns with its body, where rate^2 comes to beta and 2 rate to alpha.
    const double turn = mechanism.scene.pins > 0 ? fastest / w : 0, frames = turn * turn + 2 * turn;
    RC_ASSERT(disturbed.drift_position <= (1.02 + frames) * envelope + 20 * floor + 1e3 * off * off + 1e-13);
  }
}

/// Halving a small step divides the error by 2^order, as long as nothing happens and rounding does not rule: in one of
/// three halvings, since the first may still be too coarse for an order to show.
void hold_order(const Mechanism& mechanism, Method method, double order, double duration) {
  RC_PRE(mechanism.assembled);
  const RunStepper stepper = stepper_of(mechanism, method);
  const int n = stepper.source.tables.coordinates;
  std::vector<RunState> ends;
  double size = 1;
  for (const int steps : {4, 8, 16, 32, 64}) {
    RunState state = stepper.start();
    for (int k = 0; k < steps; ++k) {
      const Report report = stepper.step(state, duration / steps);
      RC_PRE(report.status == Status::ok && report.unlocated_events + report.events == 0);
    }
    ends.push_back(state);
    for (int j = 0; j < n; ++j) size = std::fmax(size, std::fmax(std::fabs(state.q[j]), std::fabs(state.v[j])));
  }
  std::vector<double> changes;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    double change = 0;
    for (int j = 0; j < n; ++j) change = std::fmax(change, std::fabs(ends[k].q[j] - ends[k - 1].q[j]));
    changes.push_back(change);
  }
  RC_PRE(changes.front() < 1e-5 * size);  // else far from what an order says anything of
  bool shown = false;
  for (std::size_t k = 1; k < changes.size(); ++k) {
    shown = shown || changes[k] <= changes[k - 1] * std::exp2(-order) * 1.5 || changes[k] < 1e-13 * size;
  }
  RC_ASSERT(shown);
}

RC_GTEST_PROP(StepProperty, EulerIsOfOrderOne, (const Mechanism& mechanism)) {
  hold_order(mechanism, Method::euler, 1, 4e-4);
}
RC_GTEST_PROP(StepProperty, Rk4IsOfOrderFour, (const Mechanism& mechanism)) {
  hold_order(mechanism, Method::rk4, 4, 1e-2);
}
RC_GTEST_PROP(StepProperty, Rk4LocatedIsOfOrderFour, (const Mechanism& mechanism)) {
  hold_order(mechanism, Method::rk4_located, 4, 1e-2);
}
RC_GTEST_PROP(StepProperty, Dop853LocatedIsOfOrderEight, (const Mechanism& mechanism)) {
  hold_order(mechanism, Method::dop853_located, 8, 4e-2);
}

/// Forces and accelerations are the oracle's, at the start and some steps on. Mechanisms that it decides in no time.
RC_GTEST_PROP(StepProperty, AgreesWithTheOracle, (const Mechanism& mechanism)) {
  const RunStepper stepper = stepper_of(mechanism, Method::rk4_located);
  RC_PRE(mechanism.assembled && stepper.source.tables.contacts <= 4 && mechanism.scene.guides <= 3);
  RC_PRE(is_movable(stepper));
  RunStepper::Reaction r;
  RC_PRE(stepper.reaction(stepper.start(), {}, r).uniqueness < Uniqueness::motion_only);  // forces that are a choice
  RunState state = stepper.start();
  hold(judge_instant(stepper, state).violation);
  if (mechanism.stratum == Stratum::on_kink) return;  // a step on, rounding has chosen a side
  if (run(stepper, state, 1e-3, 3)) hold(judge_instant(stepper, state).violation);
}

}  // namespace
