#include "exact_instant.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace slideway::charts {
namespace {

using oracle::Real;
using oracle::Verdict;

constexpr double patterns = 4;  // of signs that the oracle does not try
constexpr double noise = 0.1;   // an answer that rounding changes by this part of itself has no digit

/// `beside`: a size of the terms that a small result is the difference of.
bool fits(const oracle::Shortfall& s, double tolerance, double beside) {
  const double scale = std::max(s.scale, beside);
  return s.error <= tolerance * scale || s.error <= std::min(patterns * s.bound, noise * scale);
}

/// Of S with ones on its diagonal, rounded to doubles: is the least eigenvalue rounding?
bool is_singular_in_doubles(const ContactProblem& p) {
  Eigen::MatrixXd S(p.n, p.n);
  for (int i = 0; i < p.n; ++i) {
    for (int j = 0; j < p.n; ++j) {
      const auto at = [&](int row, int column) { return p.S[static_cast<std::size_t>(row * p.n + column)]; };
      S(i, j) = at(i, j) / std::sqrt(at(i, i) * at(j, j));
    }
  }
  if (!std::isfinite(S.sum())) return true;
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S).eigenvalues()(0);
  return least < 8 * p.n * std::numeric_limits<double>::epsilon();
}

}  // namespace

ExactInstant::ExactInstant(const RunScene& scene, const State& state)
    : state_(state),
      model_(oracle::model_of<Real>(scene)),
      checker_(model_),
      dynamics_(model_, oracle::FrictionLaw<Real>::orders) {
  const int n = coordinates(scene);
  dynamics_.begin(dynamics_.place(Real(state.time()), {state.q, state.q + n}, {state.v, state.v + n}));
  for (int g = 0; g < scene.guides; ++g) {
    const Real& speed = dynamics_.sliding(g).speed[0];
    const bool rough = dynamics_.guide(g).rough();
    mode_.slip.push_back(!rough ? 0 : speed > 0 ? 1 : -1);
    slips_.push_back(abs(speed) <= Real(1e-14) ? 0 : speed > 0 ? 1 : -1);
    mu_.push_back(dynamics_.guide(g).mu);
  }
  mode_.sign.assign(static_cast<std::size_t>(dynamics_.contacts()), 1);
  lost_rank_ = !dynamics_.solve(mode_, oracle::Coefficients<Real>(mu_.size(), Real(0)));
  ContactProblem rounded;
  lost_rank_ = lost_rank_ || !problem(rounded) || (rounded.n > 0 && is_singular_in_doubles(rounded));
  const oracle::InstantCheck check = checker_.check(claim({}));
  verdict_ = check.verdict;
  solutions_ = check.solutions;
  relative_bound_ = check.lambda.scale > 0 ? patterns * check.lambda.bound / check.lambda.scale : 0;
}

/// Nothing but contact forces, or zeros in their place.
oracle::ClaimedInstant ExactInstant::claim(const std::vector<double>& lambda) const {
  oracle::ClaimedInstant c;
  const auto n = model_.start.q.size();
  c.t = state_.time();
  c.q.assign(state_.q, state_.q + n);
  c.v.assign(state_.v, state_.v + n);
  c.acceleration.assign(n, 0);
  c.lambda = lambda;
  c.lambda.resize(static_cast<std::size_t>(dynamics_.contacts()), 0);
  c.friction.assign(slips_.size(), 0);
  c.drive.assign(model_.drive.size(), 0);
  c.pin.assign(2 * model_.pin.size(), 0);
  c.mode = slips_;
  return c;
}

/// In the state, or in the contacts' problem in doubles.
bool ExactInstant::has_no_digits() const { return lost_rank_ || relative_bound_ > noise; }

Cell ExactInstant::refused(Status status) const {
  const bool singular = status == Status::singular_constraints || status == Status::inaccurate;
  if (has_no_digits()) return Cell::refused_rightly;
  const bool right =
      (verdict_ == Verdict::none && status == Status::no_solution) || (is_ambiguous() && status == Status::not_unique);
  return right && !singular ? Cell::refused_rightly : Cell::refused_wrongly;
}

/// Several motions, or several sets of sliding forces for a motion that drives decide.
bool ExactInstant::is_ambiguous() const {
  return verdict_ == Verdict::several || (verdict_ == Verdict::motion_only && solutions_ > 1);
}

Cell ExactInstant::judge(const io::RunStepper& stepper, double tolerance) const {
  io::RunStepper::Reaction r;
  const Report report = stepper.reaction(state_, {}, r);
  if (report.status != Status::ok) return refused(report.status);
  const auto& scene = stepper.source.scene;
  oracle::ClaimedInstant c = claim({r.lambda, r.lambda + stepper.source.tables.contacts});
  c.acceleration.assign(r.acceleration, r.acceleration + stepper.source.tables.coordinates);
  c.friction.assign(r.friction, r.friction + scene.guides);
  c.drive.assign(r.drive, r.drive + scene.drives);
  const oracle::InstantCheck check = checker_.check(c);
  if (check.verdict == Verdict::none || !check.answered) return Cell::wrong;
  if (check.verdict == Verdict::several) return report.uniqueness == Uniqueness::refuted ? Cell::right : Cell::wrong;
  const double force = check.lambda.scale, weight = std::hypot(scene.gravity.x, scene.gravity.y);
  const bool motion = fits(check.acceleration, tolerance, weight);
  const bool forces = fits(check.lambda, tolerance, 0) && fits(check.friction, tolerance, force) &&
                      fits(check.drive, tolerance, force * stepper.source.tables.length);
  return motion && (forces || check.verdict == Verdict::motion_only) ? Cell::right : Cell::wrong;
}

Cell ExactInstant::judge(const std::vector<double>& lambda, double tolerance) const {
  const bool answers = is_unique();
  if (lambda.empty()) return answers && !has_no_digits() ? Cell::refused_wrongly : Cell::refused_rightly;
  if (!answers) return Cell::wrong;
  const oracle::InstantCheck check = checker_.check(claim(lambda));
  return check.answered && fits(check.lambda, tolerance, 0) ? Cell::right : Cell::wrong;
}

double ExactInstant::relative_error(const std::vector<double>& lambda) const {
  const oracle::InstantCheck check = checker_.check(claim(lambda));
  return check.lambda.error / check.lambda.scale;
}

bool ExactInstant::problem(ContactProblem& problem) const {
  oracle::Dynamics<Real>::ContactProblem exact;
  if (!dynamics_.contact_problem(mode_, mu_, exact)) return false;
  problem = {exact.n, {}, {}, {}};
  for (std::size_t i = 0; i < exact.plus.size(); ++i) {
    problem.S.push_back(static_cast<double>(Real((exact.plus[i] + exact.minus[i]) / 2)));
    problem.S_star.push_back(static_cast<double>(Real((exact.plus[i] - exact.minus[i]) / 2)));
  }
  for (const Real& b : exact.b) problem.b.push_back(static_cast<double>(b));
  return true;
}

}  // namespace slideway::charts
