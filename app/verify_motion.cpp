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

/// Largest magnitude of a kind, and for energies of what is in play.
double largest(const Kind& kind, const Trajectory& exact) {
  double most = 0;
  for (const Instant& now : exact.samples) {
    most = std::max(most, largest(kind.exact(now)));
    if (kind.nature == Kind::energetic) most = std::max(most, largest({now.kinetic, now.energy, now.work}));
  }
  return most;
}

/// What the errors of each kind are measured by: the largest magnitude. Of a mechanism that does not move, where that
/// is nothing beside these, its length (m), that over the run (m/s), and its largest force times its length (J).
std::vector<double> scales(const Trajectory& exact, double length, double duration) {
  double force = 0;
  for (const Kind& kind : kinds()) force = kind.nature == Kind::jumps ? std::max(force, largest(kind, exact)) : force;
  std::vector<double> all;
  for (const Kind& kind : kinds()) {
    const double still = kind.nature == Kind::energetic ? force * length
                         : kind.nature == Kind::jumps   ? 0
                         : all.empty()                  ? length
                                                        : length / duration;
    const double most = largest(kind, exact);
    all.push_back(most > 1e-12 * still ? most : still);
  }
  return all;
}

/// A run with what it is held against.
struct Comparison {
  const KernelRun& run;
  const KernelRun (&finer)[2];  ///< with a half and a quarter of the step
  const Trajectory& exact;
  std::vector<double> scale;  ///< of each kind
  double start_miss;          ///< largest relative distance between both starts
  bool has_means;             ///< forces of the run are means over steps

  double duration() const { return run.samples.back().t; }
  /// Rounding over the run, relative: an ulp of the largest value for each step; and a hundred times what the start is
  /// off, if it was not moved onto the constraints.
  double rounding() const { return static_cast<double>(run.recording.steps + 16) * 0x1p-52 + 100 * start_miss; }
};

/// Largest relative distance between the run's start and the trajectory's, which is on the constraints.
double start_miss(const KernelRun& run, const Trajectory& exact, const std::vector<double>& scale) {
  double miss = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double away = distance(kinds()[k].exact(exact.samples.front()), kinds()[k].kernel(run.samples.front()));
    miss = std::max(miss, away / scale[k]);
  }
  return miss;
}

/// Samples at which forces may differ by all they are: beside events, where they are a choice, and means over the first
/// step: moreau imposes the rates of constraints within a step, so that its first step takes only a part of what turns
/// the speeds of the start, and every other one as much as a step does.
bool is_open(const Comparison& both, std::size_t i, double reach) {
  const bool first_mean = both.has_means && i == 0;
  return first_mean || near_event(both.exact, both.run.samples[i].t, reach) || both.exact.samples[i].chosen;
}

/// The bound is ten times what halving and quartering the step changes: a method of order p that converges to the
/// trajectory is off by at most 2^p / (2^p - 1) <= 2 times that, and one that converges elsewhere is off by what no
/// refining changes. To it comes rounding: over the run, and `at_an_instant`, what it makes of this kind at a single
/// state.
Check compare(const Kind& kind, const Comparison& both, double scale, double at_an_instant, double reach,
              std::size_t& compared) {
  const KernelRun& run = both.run;
  Check check{kind.quantity, kind.unit};
  check.scale = scale;
  check.bound_grows = true;
  double change = 0;
  for (std::size_t i = 0; i < both.exact.samples.size(); ++i) {
    const std::vector<double> now = kind.kernel(run.samples[i]);
    check.curve.push_back(distance(now, kind.exact(both.exact.samples[i])));
    if (kind.nature == Kind::jumps && is_open(both, i, reach)) {
      check.curve.back() = std::nan("");
      continue;
    }
    ++compared;
    if (check.curve.back() > check.error) check.t = run.samples[i].t;
    check.error = oracle::worse(check.error, check.curve.back());
    for (const KernelRun& other : both.finer) {
      if (i < other.samples.size()) change = std::max(change, distance(now, kind.kernel(other.samples[i])));
    }
  }
  check.bound = 10 * change + at_an_instant + both.rounding() * check.scale;
  return check;
}

/// Samples at which a guide slips otherwise than on the trajectory, or rests.
Check compare_modes(const Comparison& both, const Tables<io::RunSize>& tables, double reach) {
  Check check{"modes", "that differ"};
  for (std::size_t i = 0; i < both.exact.samples.size(); ++i) {
    if (!both.run.states[i].decided || near_event(both.exact, both.run.samples[i].t, reach)) continue;
    bool differs = false;
    for (std::size_t g = 0; g < both.run.samples[i].mode.size(); ++g) {
      differs = differs || (tables.is_rough[g] && both.run.samples[i].mode[g] != both.exact.samples[i].mode.slip[g]);
    }
    if (differs && check.error == 0) check.t = both.run.samples[i].t;
    check.error += differs ? 1 : 0;
  }
  return check;
}

bool is_same(const Event& a, const Event& b) {
  return a.guide == b.guide && a.contact == b.contact && a.kind == b.kind;
}

/// The event of a kind that is nearest in time, among those that are not taken; none: as many as there are.
std::size_t nearest(const std::vector<Event>& events, const Event& to, const std::vector<bool>& taken) {
  std::size_t best = events.size();
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (taken[k] || !is_same(events[k], to)) continue;
    if (best == events.size() || std::fabs(events[k].t - to.t) < std::fabs(events[best].t - to.t)) best = k;
  }
  return best;
}

/// How far event times may be off, s. Of a method that does not locate them: the run sees them at the end of a step,
/// two steps earlier or later at most, and where the motion is off by the part `late` of itself, by as much of the run.
/// Of one that does: ten times what halving and quartering the step changes, as for every other quantity, and the part
/// `rounded` of the run.
double event_bound(const Comparison& both, double late, double rounded) {
  const Recording& recording = both.run.recording;
  if (!recording.located) return 2 * recording.dt + late * both.duration();
  double change = 0;
  for (const KernelRun& other : both.finer) {
    const std::vector<bool> free(other.recording.events.size(), false);
    for (const Event& event : recording.events) {
      const std::size_t k = nearest(other.recording.events, event, free);
      if (k < free.size()) change = std::max(change, std::fabs(other.recording.events[k].t - event.t));
    }
  }
  return 10 * change + rounded * both.duration();
}

/// Each event of the trajectory is one of the run's, within the bound. Not asked for: two of a kind closer than that,
/// or than a step that does not locate them; and events that close to the start, which has nothing to compare with, or
/// to the end. Of means over steps the first is of another kind than the second: what changes between them is no event.
Check compare_events(const Comparison& both, const std::vector<Event>& events, double bound, Check& missed) {
  const std::vector<Event>& seen = both.run.recording.events;
  const double close = both.run.recording.located ? bound : both.run.recording.dt;
  Check times{"event times", "s"};
  times.scale = both.duration();
  times.bound = bound;
  times.bound_grows = true;
  const auto miss = [&](double t) {
    if (missed.error == 0) missed.t = t;
    missed.error += 1;
  };
  std::vector<bool> taken(seen.size(), false);
  for (const Event& event : events) {
    const std::size_t best = nearest(seen, event, taken);
    if (best < seen.size() && std::fabs(seen[best].t - event.t) <= bound) {
      taken[best] = true;
      const double error = std::fabs(seen[best].t - event.t);
      if (error > times.error) times.t = event.t;
      times.error = std::max(times.error, error);
      continue;
    }
    const bool paired = std::any_of(events.begin(), events.end(), [&](const Event& other) {
      return &other != &event && other.guide == event.guide && other.contact == event.contact &&
             std::fabs(other.t - event.t) <= close;
    });
    if (event.t > close && !paired && event.t < both.duration() - bound) miss(event.t);
  }
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const bool beside = taken[k] || near_event(both.exact, seen[k].t, bound, seen[k].guide);
    const bool first = both.has_means && seen[k].t <= 2 * both.run.recording.dt;
    if (!beside && !first && seen[k].t <= both.duration() - bound) miss(seen[k].t);
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

/// The trajectory's events, contacts counted within their guides.
std::vector<Event> events_of(const Trajectory& exact, const Scene<io::RunSize>& scene) {
  std::vector<Event> events;
  for (const auto& event : exact.events) {
    int contact = event.contact;
    for (int g = 0; g < event.guide && contact != none; ++g) contact -= scene.guide[g].contacts;
    events.push_back({static_cast<double>(event.t), event.guide, contact, event.kind});
  }
  return events;
}

/// What the comparison leaves out.
void say_what_is_not_checked(const Comparison& both, Verification& verification) {
  auto& not_checked = verification.not_checked;
  if (both.exact.unverified) {
    not_checked.push_back(
        "That the trajectory takes the only possible mode after each event: there were too many to try them all.");
  }
  for (const KernelRun& other : both.finer) {
    if (other.recording.status == Status::ok) continue;
    not_checked.push_back("Convergence beyond t = " + fmt::format("{:.6g} s", other.recording.t) +
                          ", where the kernel refuses a finer step.");
  }
  if (both.start_miss > 1e-12) {
    not_checked.push_back(fmt::format(
        "The run from this very start, which misses the constraints by {:.1e} of the motion: --project-start moves it.",
        both.start_miss));
  }
  if (both.has_means) not_checked.push_back("Forces over the first step: they are means of a part of it.");
  const auto& samples = both.exact.samples;
  if (std::any_of(samples.begin(), samples.end(), [](const Instant& now) { return now.chosen; })) {
    not_checked.push_back("Forces over the run where guides at rest outnumber the freedom: they are a choice.");
  }
}

/// What rounding makes of a kind at a single state.
double bound_at_an_instant(const Verification& verification, const Kind& kind) {
  double bound = 0;
  for (const Check& check : verification.groups.front().checks) {
    if (check.quantity == std::string(kind.quantity)) bound = check.bound;
  }
  return bound;
}

/// What rounding makes of a zero's time, as a part of the run: of speeds and contact forces, which vary by their size
/// within it.
double rounding_of_zeros(const Comparison& both, const Verification& verification) {
  double worst = both.rounding();
  for (std::size_t k = 0; k < kinds().size(); ++k) {
    const Kind& kind = kinds()[k];
    if (kind.nature == Kind::energetic || !(both.scale[k] > 0)) continue;
    worst = std::max(worst, both.rounding() + bound_at_an_instant(verification, kind) / both.scale[k]);
  }
  return worst;
}

}  // namespace

CheckGroup check_motion(const Preparation& prepared, Verification& verification, Progress& progress) {
  const KernelRun& run = verification.run;
  const KernelRun finer[2] = {run_kernel(prepared, 2, progress), run_kernel(prepared, 4, progress)};
  const auto [exact, digits] = trajectory(prepared, run, progress);
  verification.reference_digits = digits;
  verification.reference_steps = exact.steps;
  verification.reference_events = events_of(exact, run.recording.file.scene);
  constexpr double digits_needed = 18;  // two more than a double's
  if (exact.end != oracle::End::duration) {
    verification.reference_end = fmt::format("ends at t = {:.9g} s: {}", static_cast<double>(exact.t), why(exact.end));
  } else if (digits < digits_needed) {
    verification.reference_end = fmt::format("is no reference: its two runs share {:.0f} digits", digits);
  }
  const auto& tables = prepared.stepper->source.tables;
  const std::vector<double> scale = scales(exact, tables.length, run.samples.back().t);
  const Comparison both{
      run, finer, exact, scale, start_miss(run, exact, scale), prepared.stepper->method == Method::moreau};
  say_what_is_not_checked(both, verification);
  CheckGroup group{"Over the run", "against the oracle's trajectory from the same start", {}};
  const double rounded = rounding_of_zeros(both, verification);
  double late = 0;
  const auto reach = [&] { return event_bound(both, late, rounded); };  // speeds come before what jumps
  for (std::size_t k = 0; k < kinds().size(); ++k) {
    const Kind& kind = kinds()[k];
    std::size_t compared = 0;
    const Check check = compare(kind, both, scale[k], bound_at_an_instant(verification, kind), reach(), compared);
    if (check.quantity == "speeds" && check.scale > 0) late = check.bound / check.scale;
    if (compared == 0) {
      if (check.scale > 0) {
        verification.not_checked.push_back(
            fmt::format("{} over the run: all samples are beside events, or a choice.", kind.quantity));
      }
    } else if (check.scale > 0 || !(check.error <= check.bound)) {
      group.checks.push_back(check);
    }
  }
  Check missed{"events", "missed or made up"};
  const double bound = event_bound(both, late, rounded);
  const Check times = compare_events(both, verification.reference_events, bound, missed);
  if (!exact.events.empty()) group.checks.push_back(times);
  if (run.recording.file.scene.guides > 0) {
    group.checks.push_back(missed);
    group.checks.push_back(compare_modes(both, tables, bound));
  }
  return group;
}

}  // namespace slideway::app
