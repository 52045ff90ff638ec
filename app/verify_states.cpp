// At states of a run: the kernel's accelerations and forces beside the oracle's, and its claims.
#include <algorithm>
#include <cmath>
#include <slideway/oracle/check.hpp>

#include "verify_model.hpp"

namespace slideway::app {
namespace {

constexpr std::size_t most_states = 64;

oracle::ClaimedInstant claim_of(const KernelRun& run, std::size_t i) {
  const Sample& s = run.samples[i];
  std::vector<double> pin;
  for (const Vec2& f : s.pin) pin.insert(pin.end(), {f.x, f.y});
  return {s.t, s.q, s.v, run.accelerations[i], s.lambda, s.friction, s.drive, pin, s.mode, s.energy};
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
      slip{"dissipation", "guides driven by friction"}, uniqueness{"uniqueness", "false claims"},
      unsolved{"states", "that the oracle cannot solve"};
  // Two sums of up to two products each, in the kernel and once more in what is tested here.
  coulomb.scale = 1;
  coulomb.bound = 8 * 0x1p-52;
  bool undecided = false, untried = false;
  int branching = 0;
  const std::size_t count_of_samples = run.samples.size();
  const std::size_t stride = (count_of_samples + most_states - 1) / most_states;
  std::size_t states = 0;
  for (std::size_t i = 0; i < count_of_samples; i += stride, ++states) {
    const oracle::ClaimedInstant claim = claim_of(run, i);
    const oracle::InstantCheck found = checker.check(claim);
    untried = untried || found.verdict == oracle::Verdict::unverified || found.verdict == oracle::Verdict::undecided;
    count(uniqueness, !is_true(run.uniqueness[i], found), claim.t);
    count(unsolved, !found.answered && found.verdict != oracle::Verdict::undecided, claim.t);
    if (!found.answered) continue;
    branching += found.solutions > 1 ? 1 : 0;
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
    undecided = undecided || (!found.decided && run.uniqueness[i] == Uniqueness::certified);
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
  CheckGroup group{"At states of the run",
                   fmt::format("the equations at {} of its states, solved by the oracle for the same q and v", states),
                   {}};
  for (Check* check : {&acceleration, &lambda, &friction, &drive, &pin, &energy}) {
    if (check->bound > 0 || !(check->error <= 0)) group.checks.push_back(*check);
  }
  group.checks.push_back(unsolved);
  if (scene.guides > 0) group.checks.insert(group.checks.end(), {coulomb, faces, slip, uniqueness});
  return group;
}

}  // namespace slideway::app
