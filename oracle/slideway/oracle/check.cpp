#include <slideway/oracle/check.hpp>
#include <slideway/oracle/hlcp.hpp>

namespace slideway::oracle {
namespace {

double largest(const std::vector<Real>& values) {
  Real most(0);
  for (const Real& x : values) most = worse(most, Real(abs(x)));
  return static_cast<double>(most);
}

template <class Other>
std::vector<Real> difference(const std::vector<Real>& a, const std::vector<Other>& b) {
  std::vector<Real> d;
  for (std::size_t i = 0; i < a.size(); ++i) d.push_back(a[i] - Real(b[i]));
  return d;
}

}  // namespace

Checker::Checker(const Model<Real>& model) : dynamics_(model, FrictionLaw<Real>::orders + 1), law_(dynamics_) {}

Motion<Real> Checker::place(const ClaimedInstant& claim, int perturbation) const {
  std::vector<Real> q(claim.q.begin(), claim.q.end()), v(claim.v.begin(), claim.v.end());
  const auto perturb = [&](std::vector<Real>& x, std::size_t period) {
    const Real ulp = Real(0x1p-52) * Real(largest(x));
    for (std::size_t j = 0; j < x.size(); ++j) x[j] += j / period % 2 == 0 ? ulp : Real(-ulp);
  };
  if (perturbation > 0) {
    perturb(q, static_cast<std::size_t>(perturbation));
    perturb(v, static_cast<std::size_t>(perturbation) + 1);
  }
  return dynamics_.place(Real(claim.t), q, v);
}

/// Of the solution that the dynamics have.
Checker::Answer Checker::answer() const {
  const auto& mechanism = dynamics_.mechanism;
  Answer a;
  for (const auto& row : mechanism.coordinate) {
    Real sum = row.turning[0];
    for (int j = 0; j < 3; ++j) {
      const auto e = static_cast<std::size_t>(j);
      if (row.a != ground) sum += row.on_a[e][0] * dynamics_.unknown(3 * row.a + j, 0);
      if (row.b != ground) sum += row.on_b[e][0] * dynamics_.unknown(3 * row.b + j, 0);
    }
    a.acceleration.push_back(sum);
  }
  for (int c = 0; c < dynamics_.contacts(); ++c) a.lambda.push_back(dynamics_.lambda(c, 0));
  for (int g = 0; g < dynamics_.guides(); ++g) a.friction.push_back(dynamics_.friction(g, 0));
  for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
    a.drive.push_back(dynamics_.unknown(dynamics_.unknown_of_drive(static_cast<int>(d)), 0));
  }
  for (std::size_t p = 0; p < mechanism.model.pin.size(); ++p) {
    const int row = 2 * static_cast<int>(p), b = mechanism.model.pin[p].b;
    const Real x = dynamics_.unknown(dynamics_.unknown_of_pin(row), 0);
    const Real y = dynamics_.unknown(dynamics_.unknown_of_pin(row + 1), 0);
    const Real c = b == ground ? Real(1) : mechanism.turn(b).cosine[0];
    const Real s = b == ground ? Real(0) : mechanism.turn(b).sine[0];
    a.pin.insert(a.pin.end(), {Real(c * x - s * y), Real(s * x + c * y)});
  }
  a.energy = {mechanism.potential[0]};
  for (int i = 0; i < 3 * mechanism.bodies(); ++i) {
    const Real& v = mechanism.position(i)[1];
    a.energy.front() += mechanism.mass(i) * v * v / 2;
  }
  return a;
}

InstantCheck Checker::check(const ClaimedInstant& claim) {
  InstantCheck result;
  check_claims(claim, result);
  const Motion<Real> motion = place(claim, 0);
  std::vector<bool> at_rest;
  for (int g = 0; g < dynamics_.guides(); ++g) {
    at_rest.push_back(dynamics_.guide(g).rough() && claim.mode[static_cast<std::size_t>(g)] == 0);
  }
  const Decision<Real> decision = law_.decide(motion, at_rest);
  result.verdict = decision.verdict;
  if (decision.solutions.empty()) return result;
  result.solutions = decision.verdict == Verdict::unverified ? 0 : static_cast<int>(decision.solutions.size());

  // Where there are several, the claim is held against the nearest.
  const auto away = [&](const Solution<Real>& s) { return largest(difference(s.lambda, claim.lambda)); };
  const Solution<Real>* taken = &decision.solutions.front();
  for (const Solution<Real>& s : decision.solutions) taken = away(s) < away(*taken) ? &s : taken;
  decide_uniqueness(taken->mode, decision.mu, result);

  dynamics_.begin(motion);
  if (!dynamics_.solve(taken->mode, decision.mu)) return result;
  const Answer exact = answer();
  result.answered = true;
  std::vector<Answer> moved;
  for (int perturbation = 1; perturbation <= 2; ++perturbation) {
    dynamics_.begin(place(claim, perturbation));
    if (dynamics_.solve(taken->mode, decision.mu)) moved.push_back(answer());
  }
  const auto compare = [&](std::vector<Real> Answer::*kind, const std::vector<double>& claimed) {
    Shortfall s{largest(difference(exact.*kind, claimed)), largest(exact.*kind), 0};
    double change = 0x1p-52 * s.scale;
    for (const Answer& other : moved) change = std::max(change, largest(difference(exact.*kind, other.*kind)));
    s.bound = ulps * (dynamics_.mechanism.bodies() + 1) * std::sqrt(2.0 * static_cast<double>(claim.q.size())) * change;
    return s;
  };
  result.acceleration = compare(&Answer::acceleration, claim.acceleration);
  result.lambda = compare(&Answer::lambda, claim.lambda);
  result.friction = compare(&Answer::friction, claim.friction);
  result.drive = compare(&Answer::drive, claim.drive);
  result.pin = compare(&Answer::pin, claim.pin);
  result.energy = compare(&Answer::energy, {claim.energy});
  for (std::size_t c = 0; c < claim.lambda.size(); ++c) {
    const double x = claim.lambda[c];
    result.wrong_faces += std::fabs(x) > result.lambda.bound && (x > 0) != (exact.lambda[c] > 0) ? 1 : 0;
  }
  return result;
}

/// Coulomb's law among the claimed numbers themselves, for guides that slip.
void Checker::check_claims(const ClaimedInstant& claim, InstantCheck& result) const {
  for (int g = 0, c = 0; g < dynamics_.guides(); ++g) {
    const auto& guide = dynamics_.guide(g);
    Real limit = guide.preload;
    for (std::size_t k = 0; k < guide.contact.size(); ++k, ++c) {
      limit += guide.mu * Real(std::fabs(claim.lambda[static_cast<std::size_t>(c)]));
    }
    const auto at = static_cast<std::size_t>(g);
    if (!guide.rough() || claim.mode[at] == 0 || guide.viscous > 0) continue;
    const Real against = Real(-claim.mode[at]) * Real(claim.friction[at]);  // >= 0 when friction resists
    if (!(limit <= 0)) result.coulomb = worse(result.coulomb, static_cast<double>(Real(abs(against - limit) / limit)));
    result.against_slip = result.against_slip && against >= 0;
  }
}

void Checker::decide_uniqueness(const Mode& mode, const Coefficients<Real>& mu, InstantCheck& result) {
  const auto resting = [&](int g) { return dynamics_.guide(g).rough() && mode.slip[static_cast<std::size_t>(g)] == 0; };
  for (int g = 0; g < dynamics_.guides(); ++g) {
    if (resting(g)) return;
  }
  typename Dynamics<Real>::ContactProblem problem;
  if (dynamics_.contacts() > exact_max_order || !dynamics_.contact_problem(mode, mu, problem)) return;
  const auto square = [&](const std::vector<Real>& flat) {
    std::vector<std::vector<Real>> rows;
    for (auto from = flat.begin(); from != flat.end(); from += problem.n) rows.emplace_back(from, from + problem.n);
    return rows;
  };
  result.decided = true;
  result.certified = has_w_property(exact_hlcp(problem.n, square(problem.plus), square(problem.minus), problem.b));
}

}  // namespace slideway::oracle
