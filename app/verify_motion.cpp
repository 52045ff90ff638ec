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
  enum { smooth, jumps, energetic } nature;  ///< jumps at events; measured by the energy in play
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"positions", "m, rad", [](const Instant& i) { return i.q; }, [](const Sample& s) { return s.q; }, Kind::smooth},
      {"speeds", "m/s, rad/s", [](const Instant& i) { return i.v; }, [](const Sample& s) { return s.v; }, Kind::smooth},
      {"contact forces", "N", [](const Instant& i) { return i.lambda; }, [](const Sample& s) { return s.lambda; },
       Kind::jumps},
      {"friction", "N", [](const Instant& i) { return i.friction; }, [](const Sample& s) { return s.friction; },
       Kind::jumps},
      {"drive forces", "N, N m", [](const Instant& i) { return i.drive; }, [](const Sample& s) { return s.drive; },
       Kind::jumps},
      {"pin forces", "N", [](const Instant& i) { return i.pin; },
       [](const Sample& s) {
         std::vector<double> flat;
         for (const Vec2& f : s.pin) flat.insert(flat.end(), {f.x, f.y});
         return flat;
       },
       Kind::jumps},
      {"energy", "J", [](const Instant& i) { return std::vector<Real>{i.energy}; },
       [](const Sample& s) { return std::vector<double>{s.energy}; }, Kind::energetic},
      {"work", "J", [](const Instant& i) { return std::vector<Real>{i.work}; },
       [](const Sample& s) { return std::vector<double>{s.work}; }, Kind::energetic},
      {"dissipated", "J", [](const Instant& i) { return std::vector<Real>{i.dissipated}; },
       [](const Sample& s) { return std::vector<double>{s.dissipated}; }, Kind::energetic}};
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

/// Of any guide, or of one.
bool near_event(const Trajectory& exact, double t, double reach, int guide = none) {
  return std::any_of(exact.events.begin(), exact.events.end(), [&](const auto& event) {
    return (guide == none || guide == event.guide) && std::fabs(static_cast<double>(event.t) - t) <= reach;
  });
}

double largest(const std::vector<Real>& x) { return distance(x, std::vector<double>(x.size())); }

/// What a kind's errors are measured by.
double scale_of(const Kind& kind, const Trajectory& exact) {
  double scale = 0;
  for (const Instant& now : exact.samples) {
    scale = std::max(scale, largest(kind.exact(now)));
    if (kind.nature == Kind::energetic) scale = std::max(scale, largest({now.kinetic, now.energy, now.work}));
  }
  return scale;
}

/// Largest relative distance between the run's start and the trajectory's, which is on the constraints.
double start_miss(const KernelRun& run, const Trajectory& exact) {
  double miss = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double scale = scale_of(kinds()[k], exact);
    const double away = distance(kinds()[k].exact(exact.samples.front()), kinds()[k].kernel(run.samples.front()));
    if (scale > 0) miss = std::max(miss, away / scale);
  }
  return miss;
}

/// The bound is ten times what halving and quartering the step changes: a method of order p that converges to the
/// trajectory is off by at most 2^p / (2^p - 1) <= 2 times that, and one that converges elsewhere is off by what no
/// refining changes. To it comes rounding: an ulp of the largest value for each step, and `at_an_instant`, what it
/// makes of this kind at a single state; and a hundred times what the start is off, if it was not moved onto the
/// constraints.
Check compare(const Kind& kind, const KernelRun& run, const KernelRun (&finer)[2], const Trajectory& exact,
              double at_an_instant, std::size_t& compared) {
  Check check{kind.quantity, kind.unit};
  check.scale = scale_of(kind, exact);
  check.bound_grows = true;
  double change = 0;
  const double reach = 2 * run.recording.dt;
  for (std::size_t i = 0; i < exact.samples.size(); ++i) {
    const std::vector<double> now = kind.kernel(run.samples[i]);
    check.curve.push_back(distance(now, kind.exact(exact.samples[i])));
    if (kind.nature == Kind::jumps && near_event(exact, run.samples[i].t, reach)) {
      check.curve.back() = std::nan("");
      continue;
    }
    ++compared;
    if (check.curve.back() > check.error) check.t = run.samples[i].t;
    check.error = oracle::worse(check.error, check.curve.back());
    for (const KernelRun& other : finer) {
      if (i < other.samples.size()) change = std::max(change, distance(now, kind.kernel(other.samples[i])));
    }
  }
  const double ulps = static_cast<double>(run.recording.steps + 16) * 0x1p-52;
  check.bound = 10 * change + at_an_instant + (ulps + 100 * start_miss(run, exact)) * check.scale;
  return check;
}

/// Each event of the trajectory is one that the run saw at the end of a step, at most two steps later or earlier, and
/// the part `late` of the run: a motion that is off by so much may be early or late by so much. Not asked for: events
/// of the first step, which has nothing to compare with, and two of a kind within one step.
Check compare_events(const KernelRun& run, const Trajectory& exact, double late, Check& missed) {
  const double dt = run.recording.dt;
  Check times{"event times", "s"};
  times.scale = run.samples.back().t;
  times.bound = 2 * dt + late * times.scale;
  std::vector<bool> taken(run.recording.events.size(), false);
  const auto same = [](const auto& a, const Event& b, int contact) {
    return a.guide == b.guide && contact == b.contact && a.kind == b.kind;
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
    if (taken[k] || near_event(exact, t, times.bound, run.recording.events[k].guide) ||
        t > run.samples.back().t - times.bound)
      continue;
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
  for (const KernelRun& other : finer) {
    if (other.recording.status == Status::ok) continue;
    verification.not_checked.push_back("Convergence beyond t = " + fmt::format("{:.6g} s", other.recording.t) +
                                       ", where the kernel refuses a finer step.");
  }
  if (const double miss = start_miss(run, exact); miss > 1e-12) {
    verification.not_checked.push_back(fmt::format(
        "The run from this very start, which misses the constraints by {:.1e} of the motion: --project-start moves it.",
        miss));
  }
  double late = 0;
  for (const Kind& kind : kinds()) {
    double at_an_instant = 0;
    for (const Check& check : verification.groups.front().checks) {
      if (check.quantity == std::string(kind.quantity)) at_an_instant = check.bound;
    }
    std::size_t compared = 0;
    const Check check = compare(kind, run, finer, exact, at_an_instant, compared);
    if (check.quantity == "speeds" && check.scale > 0) late = check.bound / check.scale;
    if (compared == 0) {
      verification.not_checked.push_back(fmt::format("{} over the run: all samples are beside events.", kind.quantity));
    } else if (check.scale > 0 || !(check.error <= check.bound)) {
      group.checks.push_back(check);
    }
  }
  Check missed{"events", "missed or made up"};
  const Check times = compare_events(run, exact, late, missed);
  if (!exact.events.empty()) group.checks.push_back(times);
  if (run.recording.file.scene.guides > 0) group.checks.push_back(missed);
  return group;
}

}  // namespace slideway::app
