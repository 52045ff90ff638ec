#include "exact_jump.hpp"

#include <algorithm>
#include <cmath>

namespace slideway::charts {
namespace {

using oracle::Real;
using oracle::Verdict;

RunScene at_rest_with_impulse(const RunScene& scene, const State& state, double h) {
  RunScene s = scene;
  Body& body = s.body[0];
  const double rate = state.v[2];
  s.alpha = s.beta = 0;
  for (int j = 0; j < 3; ++j) {
    body.q[j] = state.q[j] + h / 2 * state.v[j];
    body.v[j] = 0;
  }
  const double turn = body.q[2];
  const Vec2 com{std::cos(turn) * body.com.x - std::sin(turn) * body.com.y,
                 std::sin(turn) * body.com.x + std::cos(turn) * body.com.y};
  const Vec2 velocity{state.v[0] - rate * com.y, state.v[1] + rate * com.x};
  Load& load = s.load[s.loads++];
  load = {};
  load.at = body.com;
  load.force = {body.mass / h * velocity.x, body.mass / h * velocity.y};
  load.torque = body.inertia / h * rate;
  return s;
}

}  // namespace

ExactJump::ExactJump(const RunScene& scene, const State& state, double h) : restoring_(scene.beta / scene.alpha) {
  RunScene held = at_rest_with_impulse(scene, state, h);
  const auto solve = [&](bool rounded) {
    const auto model = oracle::model_of<Real>(held);
    oracle::Dynamics<Real> dynamics(model, oracle::FrictionLaw<Real>::orders);
    oracle::FrictionLaw<Real> law(dynamics);
    const auto motion = dynamics.place(Real(0), model.start.q, model.start.v);
    const auto rests = law.find_at_rest(motion, Real(oracle::rest_in_doubles));
    const auto decision = rounded ? law.decide_rounded(motion, rests) : law.decide(motion, rests);
    if (rounded) verdict_ = decision.verdict;
    if (decision.solutions.empty()) return;
    const auto& solution = decision.solutions.front();
    const bool slips = std::find(solution.at_rest.begin(), solution.at_rest.end(), true) == solution.at_rest.end();
    if (!rounded && !slips) return;
    v_.clear();
    dynamics.begin(motion);
    for (const Real& a : dynamics.in_joints(solution.acceleration)) v_.push_back(static_cast<double>(a) * h);
  };
  solve(true);
  held.beta = restoring_ / h;
  solve(false);
  for (int j = 0; j < 3; ++j) size_ = std::max(size_, std::fabs(scene.body[0].v[j]));
  for (const double v : v_) size_ = std::max(size_, std::fabs(v));
}

Cell ExactJump::judge(const State& after, double drift) const {
  if (verdict_ == Verdict::none || verdict_ == Verdict::several) return Cell::wrong;
  double error = 0;
  for (std::size_t j = 0; j < v_.size(); ++j) error = std::max(error, std::fabs(after.v[j] - v_[j]));
  return error <= 1e-9 * size_ + 4 * restoring_ * drift ? Cell::right : Cell::wrong;
}

Cell ExactJump::refused(Status status) const {
  const bool right = (verdict_ == Verdict::none && status == Status::no_solution) ||
                     (verdict_ == Verdict::several && status == Status::not_unique);
  return right ? Cell::refused_rightly : Cell::refused_wrongly;
}

}  // namespace slideway::charts
