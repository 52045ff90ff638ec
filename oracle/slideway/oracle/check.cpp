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

/// The model with lengths and masses moved by an ulp, up and down in turns of `period`.
Model<Real> perturbed(Model<Real> model, std::size_t period) {
  std::size_t number = 0;
  const auto move = [&](Real& x) { x *= 1 + Real(number++ / period % 2 == 0 ? 0x1p-52 : -0x1p-52); };
  const auto move_both = [&](Vec<Real>& r) {
    move(r.x);
    move(r.y);
  };
  for (auto& body : model.body) {
    move_both(body.at);
    move_both(body.com);
    move(body.mass);
    move(body.inertia);
  }
  for (auto& guide : model.guide) {
    move_both(guide.origin);
    for (auto& contact : guide.contact) move_both(contact);
  }
  for (auto& pin : model.pin) {
    move_both(pin.a_at);
    move_both(pin.b_at);
  }
  return model;
}

}  // namespace

Checker::Checker(const Model<Real>& model) : dynamics_(model, FrictionLaw<Real>::orders + 1), law_(dynamics_) {
  for (std::size_t period = 1; period <= 2; ++period) {
    perturbed_.push_back(std::make_unique<Dynamics<Real>>(perturbed(model, period), FrictionLaw<Real>::orders));
  }
}

Motion<Real> Checker::place(const ClaimedInstant& claim, const Dynamics<Real>& dynamics, int perturbation) {
  std::vector<Real> q(claim.q.begin(), claim.q.end()), v(claim.v.begin(), claim.v.end());
  const auto perturb = [&](std::vector<Real>& x, std::size_t period) {
    const Real ulp = Real(0x1p-52) * Real(largest(x));
    for (std::size_t j = 0; j < x.size(); ++j) x[j] += j / period % 2 == 0 ? ulp : Real(-ulp);
  };
  if (perturbation > 0) {
    perturb(q, static_cast<std::size_t>(perturbation));
    perturb(v, static_cast<std::size_t>(perturbation) + 1);
  }
  return dynamics.place(Real(claim.t), q, v);
}

/// Of the solution that the dynamics have.
Checker::Answer Checker::answer(const Dynamics<Real>& dynamics) {
  const auto& mechanism = dynamics.mechanism;
  Answer a;
  std::vector<Real> cartesian;
  for (int i = 0; i < 3 * mechanism.bodies(); ++i) cartesian.push_back(dynamics.unknown(i, 0));
  a.acceleration = dynamics.in_joints(cartesian);
  for (std::size_t j = 0; j < a.acceleration.size(); ++j) a.acceleration[j] += mechanism.coordinate[j].turning[0];
  for (int c = 0; c < dynamics.contacts(); ++c) a.lambda.push_back(dynamics.lambda(c, 0));
  for (int g = 0; g < dynamics.guides(); ++g) a.friction.push_back(dynamics.friction(g, 0));
  for (std::size_t d = 0; d < mechanism.law.size(); ++d) {
    a.drive.push_back(dynamics.unknown(dynamics.unknown_of_drive(static_cast<int>(d)), 0));
  }
  for (std::size_t p = 0; p < mechanism.model.pin.size(); ++p) {
    const int row = 2 * static_cast<int>(p), b = mechanism.model.pin[p].b;
    const Real x = dynamics.unknown(dynamics.unknown_of_pin(row), 0);
    const Real y = dynamics.unknown(dynamics.unknown_of_pin(row + 1), 0);
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

/// Guides that the claim calls at rest, and those that do not move in it.
std::vector<bool> Checker::at_rest(const ClaimedInstant& claim, const Motion<Real>& motion) {
  std::vector<bool> rests = law_.find_at_rest(motion, Real(rest_in_doubles));
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const auto at = static_cast<std::size_t>(g);
    rests[at] = rests[at] || (dynamics_.guide(g).rough() && claim.mode[at] == 0);
  }
  return rests;
}

/// All guides that rest held, contacts on their claimed faces; a guide that the others hold already has the friction
/// that is claimed of it.
Checker::Setting Checker::as_claimed(const ClaimedInstant& claim, const Solution<Real>& taken,
                                     const Coefficients<Real>& mu) {
  Setting setting{taken.mode, mu, std::vector<Real>(mu.size(), Real(0))};
  for (std::size_t c = 0; c < claim.lambda.size(); ++c) setting.mode.sign[c] = claim.lambda[c] < 0 ? -1 : 1;
  const auto free = [&](std::size_t g) {  // for solve(), it slips without Coulomb's friction
    setting.mode.slip[g] = 1;
    setting.mu[g] = 0;
    setting.applied[g] = Real(claim.friction[g]) + dynamics_.guide(static_cast<int>(g)).preload;
  };
  for (std::size_t g = 0; g < mu.size(); ++g) {
    if (taken.at_rest[g]) free(g);
  }
  for (std::size_t g = 0; g < mu.size(); ++g) {
    if (!taken.at_rest[g]) continue;
    setting.mode.slip[g] = 0;
    setting.mu[g] = mu[g];
    setting.applied[g] = 0;
    if (!dynamics_.solve(setting.mode, setting.mu, setting.applied)) free(g);
  }
  return setting;
}

/// Largest sum of the magnitudes of forces on a body's coordinate over its mass, in the solution that the dynamics
/// have. Nothing where it does not count.
Real Checker::cancelled(const Solution<Real>& taken) const {
  Real most(0);
  const bool rests = std::find(taken.at_rest.begin(), taken.at_rest.end(), true) != taken.at_rest.end();
  if (!rests && dynamics_.mechanism.model.alpha > 0) return most;
  for (int i = 0; i < 3 * dynamics_.mechanism.bodies(); ++i) {
    const Real mass = dynamics_.mechanism.mass(i);
    if (mass > 0) most = std::max(most, Real(dynamics_.load(i) / mass));
  }
  return most;
}

InstantCheck Checker::check(const ClaimedInstant& claim) {
  InstantCheck result;
  const Motion<Real> motion = place(claim, dynamics_, 0);
  const Decision<Real> decision = law_.decide_rounded(motion, at_rest(claim, motion));
  result.verdict = decision.verdict;
  if (decision.solutions.empty()) return result;
  result.solutions = decision.verdict == Verdict::unverified ? 0 : static_cast<int>(decision.solutions.size());

  // Where there are several, the claim is held against the nearest.
  const auto away = [&](const Solution<Real>& s) { return largest(difference(s.lambda, claim.lambda)); };
  const Solution<Real>* taken = &decision.solutions.front();
  for (const Solution<Real>& s : decision.solutions) taken = away(s) < away(*taken) ? &s : taken;
  decide_uniqueness(taken->mode, decision.mu, result);

  dynamics_.begin(motion);
  Setting setting{taken->mode, decision.mu, {}};
  result.chosen = decision.verdict == Verdict::motion_only || !dynamics_.solve(setting.mode, setting.mu);
  if (result.chosen) setting = as_claimed(claim, *taken, decision.mu);
  const auto solve = [&](Dynamics<Real>& dynamics) {
    return dynamics.solve(setting.mode, setting.mu, setting.applied);
  };
  if (!solve(dynamics_)) return result;
  const Answer exact = answer(dynamics_);
  const double cancelled = static_cast<double>(this->cancelled(*taken));
  result.answered = true;
  std::vector<Answer> moved;
  for (const auto& dynamics : perturbed_) {
    dynamics->begin(place(claim, *dynamics, static_cast<int>(moved.size()) + 1));
    if (solve(*dynamics)) moved.push_back(answer(*dynamics));
  }
  const auto compare = [&](std::vector<Real> Answer::*kind, const std::vector<double>& claimed, double beside = 0) {
    Shortfall s{largest(difference(exact.*kind, claimed)), largest(exact.*kind), 0};
    double change = 0x1p-52 * std::max(s.scale, beside);
    for (const Answer& other : moved) change = std::max(change, largest(difference(exact.*kind, other.*kind)));
    s.bound = ulps * (dynamics_.mechanism.bodies() + 1) * std::sqrt(2.0 * static_cast<double>(claim.q.size())) * change;
    return s;
  };
  result.acceleration = compare(&Answer::acceleration, claim.acceleration);
  result.acceleration.bound += 4 * 0x1p-52 * cancelled;
  result.lambda = compare(&Answer::lambda, claim.lambda);
  result.friction = compare(&Answer::friction, claim.friction, result.lambda.scale);  // of one force with it
  result.drive = compare(&Answer::drive, claim.drive);
  result.pin = compare(&Answer::pin, claim.pin);
  result.energy = compare(&Answer::energy, {claim.energy});
  for (std::size_t c = 0; c < claim.lambda.size(); ++c) {
    const double x = claim.lambda[c];
    result.wrong_faces += std::fabs(x) > result.lambda.bound && (x > 0) != (exact.lambda[c] > 0) ? 1 : 0;
  }
  check_sliding(claim, *taken, result);
  check_rest(claim, *taken, result);
  // Beside a limit, where doubles put what is at it, forces may be a choice between sets that differ by their rounding.
  const bool alike = std::all_of(decision.solutions.begin(), decision.solutions.end(), [&](const Solution<Real>& s) {
    return largest(difference(s.lambda, claim.lambda)) <= result.lambda.bound &&
           largest(difference(s.friction, claim.friction)) <= result.friction.bound;
  });
  if (result.verdict == Verdict::motion_only && alike) result.verdict = Verdict::unique;
  return result;
}

/// mu Lambda + preload, by the claimed contact forces.
Real Checker::limit(const ClaimedInstant& claim, int g, const Real& mu) const {
  Real sum = dynamics_.guide(g).preload;
  for (std::size_t c = 0; c < claim.lambda.size(); ++c) {
    if (dynamics_.mechanism.guide_of[c] == g) sum += mu * Real(std::fabs(claim.lambda[c]));
  }
  return sum;
}

/// Coulomb's law among the claimed numbers themselves, for guides that slip from then on.
void Checker::check_sliding(const ClaimedInstant& claim, const Solution<Real>& taken, InstantCheck& result) const {
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const auto& guide = dynamics_.guide(g);
    const auto at = static_cast<std::size_t>(g);
    if (!guide.rough() || taken.at_rest[at] || guide.viscous > 0) continue;
    const Real against = Real(-taken.mode.slip[at]) * Real(claim.friction[at]);  // >= 0 when friction resists
    const Real law = limit(claim, g, guide.mu);
    if (!(law <= 0)) result.coulomb = worse(result.coulomb, static_cast<double>(Real(abs(against - law) / law)));
    result.against_slip = result.against_slip && against >= 0;
  }
}

/// And for those that stay at rest: both sides of the limit with the errors that they may have.
void Checker::check_rest(const ClaimedInstant& claim, const Solution<Real>& taken, InstantCheck& result) const {
  for (int g = 0; g < dynamics_.guides(); ++g) {
    const auto& guide = dynamics_.guide(g);
    const auto at = static_cast<std::size_t>(g);
    if (!guide.rough() || !taken.at_rest[at]) continue;
    const Real room = Real(result.friction.bound) +
                      guide.mu_static * Real(result.lambda.bound) * Real(static_cast<int>(guide.contact.size()));
    result.beyond_limit += abs(Real(claim.friction[at])) > limit(claim, g, guide.mu_static) + room ? 1 : 0;
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
