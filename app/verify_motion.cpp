// A run of the kernel beside the oracle's trajectory from the same start.
#include <algorithm>
#include <cmath>
#include "verify_model.hpp"

namespace slideway::app {
namespace {

using oracle::Real;
using Trajectory = oracle::Trajectory<Real>;
using Instant = oracle::Instant<Real>;

/// A kind of quantity, in the oracle's answer and in the kernel's.
struct Kind {
  const char *quantity, *unit;
  std::vector<Real> (*exact)(const Instant&);
  std::vector<double> (*kernel)(const Sample&);
  bool jumps;  ///< at events
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"positions", "m, rad", [](const Instant& i) { return i.q; }, [](const Sample& s) { return s.q; }, false},
      {"speeds", "m/s, rad/s", [](const Instant& i) { return i.v; }, [](const Sample& s) { return s.v; }, false},
      {"contact forces", "N", [](const Instant& i) { return i.lambda; }, [](const Sample& s) { return s.lambda; },
       true},
      {"friction", "N", [](const Instant& i) { return i.friction; }, [](const Sample& s) { return s.friction; }, true},
      {"drive forces", "N, N m", [](const Instant& i) { return i.drive; }, [](const Sample& s) { return s.drive; },
       true},
      {"pin forces", "N", [](const Instant& i) { return i.pin; },
       [](const Sample& s) {
         std::vector<double> flat;
         for (const Vec2& f : s.pin) flat.insert(flat.end(), {f.x, f.y});
         return flat;
       },
       true},
      {"energy", "J", [](const Instant& i) { return std::vector<Real>{i.energy}; },
       [](const Sample& s) { return std::vector<double>{s.energy}; }, false},
      {"work", "J", [](const Instant& i) { return std::vector<Real>{i.work}; },
       [](const Sample& s) { return std::vector<double>{s.work}; }, false},
      {"dissipated", "J", [](const Instant& i) { return std::vector<Real>{i.dissipated}; },
       [](const Sample& s) { return std::vector<double>{s.dissipated}; }, false}};
  return all;
}

template <class A, class B>
double distance(const std::vector<A>& a, const std::vector<B>& b) {
  double most = 0;
  for (std::size_t j = 0; j < a.size(); ++j)
    most = oracle::worse(most, std::fabs(static_cast<double>(Real(a[j]) - Real(b[j]))));
  return most;
}

oracle::Validated trajectory(const Preparation& prepared, const KernelRun& run, Progress& progress) {
  std::vector<Real> times;
  for (const Sample& s : run.samples) times.push_back(Real(s.t));
  const double duration = run.samples.back().t;
  oracle::TrajectoryOptions options;
  options.progress = [&](double t) { progress.show(t / duration, "of the oracle's trajectory"); };
  return oracle::integrate_twice(model_of(prepared), Real(duration), times, options);
}

bool near_event(const Trajectory& exact, double t, double reach) {
  return std::any_of(exact.events.begin(), exact.events.end(),
                     [&](const auto& event) { return std::fabs(static_cast<double>(event.t) - t) <= reach; });
}

/// The bound is ten times what halving and quartering the step changes: a method of order p that converges to the
/// trajectory is off by at most 2^p / (2^p - 1) <= 2 times that, and one that converges elsewhere is off by what no
/// refining changes. To it comes rounding, which adds up to an ulp of the largest value for each step.
Check compare(const Kind& kind, const KernelRun& run, const KernelRun (&finer)[2], const Trajectory& exact) {
  Check check{kind.quantity, kind.unit};
  double change = 0;
  const double reach = 2 * run.recording.dt;
  for (std::size_t i = 0; i < exact.samples.size(); ++i) {
    const std::vector<double> now = kind.kernel(run.samples[i]);
    const std::vector<Real> truth = kind.exact(exact.samples[i]);
    check.scale = std::max(check.scale, distance(truth, std::vector<double>(truth.size())));
    check.curve.push_back(distance(now, truth));
    if (kind.jumps && near_event(exact, run.samples[i].t, reach)) {
      check.curve.back() = std::nan("");
      continue;
    }
    if (check.curve.back() > check.error) check.t = run.samples[i].t;
    check.error = oracle::worse(check.error, check.curve.back());
    for (const KernelRun& other : finer) {
      if (i < other.samples.size()) change = std::max(change, distance(now, kind.kernel(other.samples[i])));
    }
  }
  check.bound = 10 * change + static_cast<double>(run.recording.steps + 16) * 0x1p-52 * check.scale;
  return check;
}

/// Each event of the trajectory is one that the run saw at the end of a step, at most two steps later or earlier. Not
/// asked for: events of the first step, which has nothing to compare with, and two of a kind within one step.
Check compare_events(const KernelRun& run, const Trajectory& exact, Check& missed) {
  const double dt = run.recording.dt;
  Check times{"event times", "s"};
  times.scale = run.samples.back().t;
  times.bound = 2 * dt;
  std::vector<bool> taken(run.recording.events.size(), false);
  const auto same = [](const auto& a, const Event& b, int contact) {
    return a.guide == b.guide && contact == b.contact;
  };
  for (std::size_t i = 0; i < exact.events.size(); ++i) {
    const auto& event = exact.events[i];
    const double t = static_cast<double>(event.t);
    int contact = event.contact;  // counted over all guides; the run counts within the guide
    for (int g = 0; g < event.guide && contact != none; ++g) contact -= run.recording.file.scene.guide[g].contacts;
    std::size_t best = taken.size();
    for (std::size_t k = 0; k < taken.size(); ++k) {
      const Event& seen = run.recording.events[k];
      if (taken[k] || !same(event, seen, contact) || std::fabs(seen.t - t) > times.bound) continue;
      if (best == taken.size() || std::fabs(seen.t - t) < std::fabs(run.recording.events[best].t - t)) best = k;
    }
    if (best < taken.size()) {
      taken[best] = true;
      const double error = std::fabs(run.recording.events[best].t - t);
      if (error > times.error) times.t = t;
      times.error = std::max(times.error, error);
      continue;
    }
    const bool paired = std::any_of(exact.events.begin(), exact.events.end(), [&](const auto& other) {
      return &other != &event && other.guide == event.guide && other.contact == event.contact &&
             std::fabs(static_cast<double>(other.t) - t) <= dt;
    });
    if (t <= dt || paired || t >= run.samples.back().t - times.bound) continue;
    if (missed.error == 0) missed.t = t;
    missed.error += 1;
  }
  for (std::size_t k = 0; k < taken.size(); ++k) {
    const double t = run.recording.events[k].t;
    if (taken[k] || near_event(exact, t, times.bound) || t > run.samples.back().t - times.bound) continue;
    if (missed.error == 0) missed.t = t;
    missed.error += 1;
  }
  return times;
}

const char* why(oracle::End end) {
  switch (end) {
    case oracle::End::duration:
      return "";
    case oracle::End::no_solution:
      return "no contact forces satisfy the equations from there on";
    case oracle::End::not_unique:
      return "several motions are possible from there on";
    case oracle::End::undecided:
      return "no mode was found, and there are too many to try them all";
    case oracle::End::singular:
      return "the constraints lose rank there";
    case oracle::End::too_many_events:
      return "events come without end";
    case oracle::End::start_off_constraints:
      return "its start cannot be moved onto the constraints";
  }
  return "";
}

}  // namespace

CheckGroup check_motion(const Preparation& prepared, Verification& verification, Progress& progress) {
  const KernelRun& run = verification.run;
  const KernelRun finer[2] = {run_kernel(prepared, 2, progress), run_kernel(prepared, 4, progress)};
  const auto [exact, digits] = trajectory(prepared, run, progress);
  verification.reference_digits = digits;
  verification.reference_steps = exact.steps;
  for (const auto& event : exact.events) {
    int contact = event.contact;
    for (int g = 0; g < event.guide && contact != none; ++g) contact -= run.recording.file.scene.guide[g].contacts;
    verification.reference_events.push_back({static_cast<double>(event.t), event.guide, contact, event.kind});
  }
  constexpr double digits_needed = 18;  // two more than a double's
  if (exact.end != oracle::End::duration) {
    verification.reference_end = fmt::format("ends at t = {:.9g} s: {}", static_cast<double>(exact.t), why(exact.end));
  } else if (digits < digits_needed) {
    verification.reference_end = fmt::format("is no reference: its two runs share {:.0f} digits", digits);
  }
  if (exact.unverified) {
    verification.not_checked.push_back(
        "That the trajectory takes the only possible mode after each event: there were too many to try them all.");
  }
  CheckGroup group{"Over the run", "against the oracle's trajectory from the same start", {}};
  for (const Kind& kind : kinds()) {
    const Check check = compare(kind, run, finer, exact);
    if (check.scale > 0) group.checks.push_back(check);
  }
  Check missed{"events", "missed or made up"};
  const Check times = compare_events(run, exact, missed);
  if (!exact.events.empty()) group.checks.push_back(times);
  if (run.recording.file.scene.guides > 0) group.checks.push_back(missed);
  return group;
}

}  // namespace slideway::app
