// At states of a run: the kernel's accelerations and forces beside the oracle's, and its claims.
#include <algorithm>
#include <cmath>
#include <memory>
#include <slideway/oracle/check.hpp>

#include "verify_model.hpp"

namespace slideway::app {
namespace {

constexpr std::size_t most_states = 64;

/// What the kernel says of a state of the run.
struct Claim {
  oracle::ClaimedInstant instant;
  Uniqueness uniqueness;
};

Claim claim_of(const KernelRun& run, std::size_t i) {
  const Sample& s = run.samples[i];
  std::vector<double> pin;
  for (const Vec2& f : s.pin) pin.insert(pin.end(), {f.x, f.y});
  return {{s.t, s.q, s.v, run.accelerations[i], s.lambda, s.friction, s.drive, pin, s.mode, s.energy},
          run.uniqueness[i]};
}

/// The same by another stepper; nothing where it refuses.
std::optional<Claim> claim_by(const RunStepper& stepper, const RunInputs& inputs, const KernelRun& run, std::size_t i) {
  const auto& scene = stepper.source.scene;
  Reaction<io::RunSize> r;
  const Report report = stepper.reaction(run.states[i], inputs, r);
  if (report.status != Status::ok) return std::nullopt;
  Claim claim{claim_of(run, i).instant, report.uniqueness};
  claim.instant.acceleration.assign(r.acceleration, r.acceleration + stepper.source.tables.coordinates);
  claim.instant.lambda.assign(r.lambda, r.lambda + stepper.source.tables.contacts);
  claim.instant.friction.assign(r.friction, r.friction + scene.guides);
  claim.instant.drive.assign(r.drive, r.drive + scene.drives);
  claim.instant.pin.clear();
  for (int p = 0; p < scene.pins; ++p) claim.instant.pin.insert(claim.instant.pin.end(), {r.pin[p].x, r.pin[p].y});
  return claim;
}

/// Does what is claimed of uniqueness follow from all solutions? What the oracle could not decide is not held against
/// the claim.
bool is_true(Uniqueness claim, const oracle::InstantCheck& found) {
  using oracle::Verdict;
  if (found.verdict == Verdict::none) return false;
  if (found.verdict == Verdict::unverified || found.verdict == Verdict::undecided) return true;
  switch (claim) {
    case Uniqueness::certified:
      return found.solutions == 1 && (!found.decided || found.certified);
    case Uniqueness::single:
      return found.solutions == 1 && !found.certified;
    case Uniqueness::refuted:
      return found.solutions > 1;
    case Uniqueness::motion_only:
      return found.verdict == Verdict::motion_only;
    case Uniqueness::unproven:
      return true;
  }
  return false;
}

/// Keeps the worst: the largest error in units of its bound.
void take(Check& check, const oracle::Shortfall& s, double t) {
  check.scale = std::max(check.scale, s.scale);
  check.curve.push_back(s.error);
  const bool first = check.curve.size() == 1, settled = check.error != check.error;
  if (!first && (settled || s.error * check.bound <= check.error * s.bound)) return;
  check.error = s.error;
  check.bound = s.bound;
  check.t = t;
}

void count(Check& check, bool violated, double t) {
  if (violated && check.error == 0) check.t = t;
  check.error += violated ? 1 : 0;
}

}  // namespace

CheckGroup check_states(const Preparation& prepared, Verification& verification, Progress& progress) {
  const KernelRun& run = verification.run;
  const auto& scene = prepared.recording.file.scene;
  oracle::Checker checker(model_of(prepared));

  Check acceleration{"accelerations", "m/s^2, rad/s^2"}, lambda{"contact forces", "N"}, friction{"friction", "N"},
      drive{"drive forces", "N, N m"}, pin{"pin forces", "N"}, energy{"energy", "J"},
      coulomb{"Coulomb's law", "of mu Lambda"}, faces{"complementarity", "forces on the wrong face"},
      slip{"dissipation", "guides driven by friction"}, rest{"rest", "guides held beyond their limit"},
      uniqueness{"uniqueness", "false claims"}, unsolved{"states", "that the oracle cannot solve"};
  // Two sums of up to two products each, in the kernel and once more in what is tested here.
  coulomb.scale = 1;
  coulomb.bound = 8 * 0x1p-52;
  bool undecided = false, untried = false;
  int branching = 0, chosen = 0, without = 0;
  // A method whose forces are means over steps has them at no instant: there the kernel is asked by another.
  const bool has_means = prepared.stepper->method == Method::moreau;
  const auto at_instants = std::make_unique<RunStepper>(*prepared.stepper);
  if (has_means) at_instants->method = Method::rk4;
  const std::size_t count_of_samples = run.samples.size();
  const std::size_t stride = (count_of_samples + most_states - 1) / most_states;
  std::size_t states = 0;
  for (std::size_t i = 0; i < count_of_samples; i += stride, ++states) {
    const auto said = has_means ? claim_by(*at_instants, prepared.inputs, run, i) : claim_of(run, i);
    without += said ? 0 : 1;
    if (!said) continue;
    const oracle::ClaimedInstant& claim = said->instant;
    const oracle::InstantCheck found = checker.check(claim);
    untried = untried || found.verdict == oracle::Verdict::unverified || found.verdict == oracle::Verdict::undecided;
    count(uniqueness, !is_true(said->uniqueness, found), claim.t);
    count(unsolved, !found.answered && found.verdict != oracle::Verdict::undecided, claim.t);
    if (!found.answered) continue;
    chosen += found.chosen ? 1 : 0;
    branching += found.solutions > 1 && !found.chosen ? 1 : 0;
    verification.acceleration_bound = std::max(verification.acceleration_bound, found.acceleration.bound);
    take(acceleration, found.acceleration, claim.t);
    take(lambda, found.lambda, claim.t);
    take(friction, found.friction, claim.t);
    take(drive, found.drive, claim.t);
    take(pin, found.pin, claim.t);
    take(energy, found.energy, claim.t);
    if (found.coulomb > coulomb.error) coulomb.t = claim.t;
    coulomb.error = oracle::worse(coulomb.error, found.coulomb);
    count(faces, found.wrong_faces > 0, claim.t);
    count(slip, !found.against_slip, claim.t);
    count(rest, found.beyond_limit > 0, claim.t);
    undecided = undecided || (!found.decided && said->uniqueness == Uniqueness::certified);
    progress.show(static_cast<double>(i) / static_cast<double>(count_of_samples), "of the states");
  }
  if (untried) {
    verification.not_checked.push_back(fmt::format(
        "Whether other signs of the {} contact forces are possible: more than {} modes an instant are not tried.",
        contacts(scene), oracle::FrictionLaw<oracle::Real>::most_modes));
  }
  if (undecided) {
    verification.not_checked.push_back(
        "The W-property that the kernel certifies: the oracle decides it for at most 12 contacts of sliding guides.");
  }
  if (branching > 0) {
    verification.not_checked.push_back(
        fmt::format("Which of several sets of forces acts, at {} of the states: the nearest was compared.", branching));
  }
  if (chosen > 0) {
    verification.not_checked.push_back(fmt::format(
        "Which forces hold guides at rest that outnumber the freedom, at {} of the states: those claimed satisfy the "
        "equations and the limits.",
        chosen));
  }
  if (has_means) {
    verification.not_checked.push_back(
        "Forces at states, which are means over steps: those that the kernel has there at instants were compared.");
  }
  if (without > 0) {
    verification.not_checked.push_back(
        fmt::format("{} of {} states: the kernel has no forces there at an instant.", without, states));
  }
  CheckGroup group{"At states of the run",
                   fmt::format("the equations at {} of its states, solved by the oracle for the same q and v", states),
                   {}};
  for (Check* check : {&acceleration, &lambda, &friction, &drive, &pin, &energy}) {
    if (check->bound > 0 || !(check->error <= 0)) group.checks.push_back(*check);
  }
  group.checks.push_back(unsolved);
  if (scene.guides > 0) group.checks.insert(group.checks.end(), {coulomb, faces, slip, rest, uniqueness});
  return group;
}

}  // namespace slideway::app
