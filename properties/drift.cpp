// Constraints of random mechanisms drift no further than the oracle says before the run.
#include <algorithm>
#include <slideway/oracle/drift.hpp>
#include <slideway/properties/rapidcheck.hpp>
#include <vector>

namespace {

using namespace slideway;
using namespace slideway::properties;
using io::RunStepper;
using oracle::Real;
using State = RunStepper::State;

oracle::TreeState<Real> tree_state(const RunStepper& stepper, const State& state) {
  const int n = stepper.source.tables.coordinates, guides = stepper.source.scene.guides;
  oracle::TreeState<Real> tree{Real(state.time()), {state.q, state.q + n}, {state.v, state.v + n}, {}};
  for (int g = 0; g < guides; ++g) {
    tree.rests.push_back(stepper.source.tables.is_rough[g] && state.decided && state.mode[g] == 0);
  }
  return tree;
}

/// By rk4_located and euler, where nothing turns over: there a step's defect is what no sample shows.
RC_GTEST_PROP(DriftProperty, StaysWithinTheOraclesBound, ()) {
  constexpr int steps = 40, spacing = 10;
  constexpr double h = 1e-3;
  const Mechanism mechanism = *rc::gen::suchThat(rc::gen::arbitrary<Mechanism>(), [](const Mechanism& drawn) {
    return drawn.assembled && drawn.stratum == Stratum::generic && drawn.scene.guides + drawn.scene.pins > 0 &&
           drawn.scene.guides <= 2;
  });
  const oracle::Scheme scheme = *rc::gen::element(oracle::Scheme::rk4_located, oracle::Scheme::euler);
  RunStepper stepper(mechanism.scene);
  stepper.method = method_of(scheme);

  State state = stepper.start();
  double position = 0, velocity = 0;
  std::vector<oracle::TreeState<Real>> states;
  for (int k = 0; k < steps; ++k) {
    if (k % spacing == 0 || k == steps - 1) states.push_back(tree_state(stepper, state));
    const Report report = stepper.step(state, h);
    RC_PRE(report.status == Status::ok && report.events + report.unlocated_events == 0);
    position = std::max(position, report.drift_position);
    velocity = std::max(velocity, report.drift_velocity);
  }

  const auto model = oracle::model_of<Real>(mechanism.scene);
  oracle::Dynamics<Real> dynamics(model, oracle::FrictionLaw<Real>::orders);
  oracle::FrictionLaw<Real> law(dynamics);
  oracle::Method<Real> method(dynamics, law);
  const auto found = oracle::drift_bound(method, scheme, Real(h), steps, states.front(), states);
  RC_PRE(found && found->stable);
  RC_ASSERT(position <= found->bound.position);
  RC_ASSERT(velocity <= found->bound.velocity);
}

}  // namespace
