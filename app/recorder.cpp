#include "recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <slideway/io/csv.hpp>

namespace slideway::app {
namespace {

constexpr long long most_samples = 2000;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void raise(Peak& peak, double value, double t) {
  if (std::fabs(value) > std::fabs(peak.value)) peak = {value, t};
}

std::vector<double> values(const double* from, int count, bool known) {
  return known ? std::vector<double>(from, from + count)
               : std::vector<double>(static_cast<std::size_t>(count), unknown);
}

/// A guide's mode just after the i-th event of a step that ends in mode `last`. An event does not tell which way a
/// guide breaks away; the end of the step does, unless the guide sticks again before it, when either way is as good.
int mode_after(const Report& report, int i, int before, int last) {
  const Event& event = report.event[i];
  if (event.kind != EventKind::slip) return event.kind == EventKind::stick ? 0 : -before;
  int sense = 1;
  for (int k = i + 1; k < report.events; ++k) {
    if (report.event[k].guide != event.guide) continue;
    if (report.event[k].kind == EventKind::stick) return sense;
    if (report.event[k].kind == EventKind::slip_reversal) sense = -sense;
  }
  return sense * last;
}

}  // namespace

std::string explain(const Recording& recording, const Report& report) {
  if (report.guide == none) return sentence(report.status);
  return fmt::format("{} ({})", sentence(report.status), recording.file.title(Item::guide, report.guide));
}

Recorder::Recorder(const RunStepper& stepper, const RunInputs& inputs, long long planned, long long every, Output& csv,
                   Recording& recording)
    : stepper_(stepper),
      inputs_(inputs),
      every_(every),
      stride_(std::max(1LL, (planned + most_samples - 1) / most_samples)),
      csv_(csv),
      recording_(recording) {
  const io::SceneFile& file = recording.file;
  recording.lambda_peak.resize(static_cast<std::size_t>(contacts(file.scene)));
  recording.friction_peak.resize(file.guide_names.size());
  recording.drive_peak.resize(file.drive_names.size());
  recording.pin_peak.resize(file.pin_names.size());
  recording.modes.resize(file.guide_names.size());
  csv_.write(csv_header(file));
}

bool Recorder::start(const RunState& state) {
  kinetic_most_ = stepper_.kinetic_energy(state);
  potential_least_ = potential_most_ = stepper_.potential_energy(state);
  recording_.energy_initial = kinetic_most_ + potential_least_;
  const bool known = observe(state);
  keep(true, true);
  const Sample& first = recording_.samples.back();
  for (std::size_t g = 0; g < recording_.modes.size(); ++g) {
    if (stepper_.source.tables.is_rough[g]) recording_.modes[g].push_back({first.t, first.mode[g]});
  }
  return known;
}

bool Recorder::step(const RunState& state, const Report& report) {
  ++recording_.steps;
  take_extremes(report);
  recording_.unlocated_events += report.unlocated_events;
  recording_.energy.work += report.energy.work;
  recording_.energy.dissipated += report.energy.dissipated;
  recording_.energy.constraint_work += report.energy.constraint_work;
  if (is_located(stepper_.method)) {
    for (int i = 0; i < report.events; ++i) add_event(report.event[i]);
  } else {
    find_events(state_, state);
  }
  const RunState before = state_;
  const bool known = observe(state);
  const bool sampled = recording_.steps % stride_ == 0;
  follow_modes(before, report, sampled);
  keep(recording_.steps % every_ == 0, sampled);
  return known;
}

void Recorder::refuse(const Report& report) {
  take_extremes(report);
  recording_.status = report.status;
  recording_.guide = report.guide;
  recording_.message =
      fmt::format("{}: at t = {:.9g} s: {}", recording_.file.file, recording_.t, explain(recording_, report));
}

void Recorder::finish() {
  keep(!row_written_, !sample_kept_);
  recording_.energy_in_play = kinetic_most_ + (potential_most_ - potential_least_) + std::fabs(recording_.energy.work);
}

bool Recorder::observe(const RunState& state) {
  state_ = state;
  recording_.t = state.time();
  row_written_ = sample_kept_ = false;
  find_energies();
  const Report report = stepper_.reaction(state, inputs_, reaction_);
  reaction_known_ = report.status == Status::ok;
  if (reaction_known_) {
    take_extremes(report);
    find_peaks();
  } else {
    refuse(report);
  }
  return reaction_known_;
}

void Recorder::take_extremes(const Report& report) {
  recording_.uniqueness = weaker(recording_.uniqueness, report.uniqueness);
  weakest_ = weaker(weakest_, report.uniqueness);
  recording_.solves_max = std::max(recording_.solves_max, report.solves);
  recording_.residual = std::fmax(recording_.residual, report.residual);
  recording_.drift_position = std::fmax(recording_.drift_position, report.drift_position);
  recording_.drift_velocity = std::fmax(recording_.drift_velocity, report.drift_velocity);
}

void Recorder::add_event(const Event& event) {
  if (recording_.events.size() < Recording::most_events) {
    recording_.events.push_back(event);
  } else {
    ++recording_.events_left_out;
  }
}

/// Of methods that do not locate events: what has changed from one state to the next.
void Recorder::find_events(const RunState& before, const RunState& now) {
  if (!before.decided) return;
  const auto& scene = recording_.file.scene;
  for (int g = 0, c = 0; g < scene.guides; ++g) {
    const int was = before.mode[g], is = now.mode[g];
    if (was != is) {
      add_event({now.time(), g, none,
                 is == 0    ? EventKind::stick
                 : was == 0 ? EventKind::slip
                            : EventKind::slip_reversal});
    }
    for (int k = 0; k < scene.guide[g].contacts; ++k, ++c) {
      if (before.sign[c] != now.sign[c]) add_event({now.time(), g, k, EventKind::normal_reversal});
    }
  }
}

/// Changes of mode at the times of located events, or as the state after the step shows them. Too many of them to keep
/// are looked at where samples are.
void Recorder::follow_modes(const RunState& before, const Report& report, bool sampled) {
  const bool all = mode_changes_ < Recording::most_events;
  if (!all && !sampled) return;
  for (std::size_t g = 0; g < recording_.modes.size(); ++g) {
    std::vector<ModeSpan>& spans = recording_.modes[g];
    if (spans.empty()) continue;
    const std::size_t had = spans.size();
    for (int i = 0; all && i < report.events; ++i) {
      const Event& event = report.event[i];
      if (event.guide != static_cast<int>(g) || event.kind == EventKind::normal_reversal) continue;
      spans.push_back({event.t, mode_after(report, i, spans.back().mode, state_.mode[g])});
    }
    if (!before.decided && spans.size() == 1) {
      spans.back().mode = state_.mode[g];  // what the first step found of the start
    } else if (spans.back().mode != state_.mode[g]) {
      spans.push_back({state_.time(), state_.mode[g]});
    }
    mode_changes_ += spans.size() - had;
  }
}

void Recorder::find_peaks() {
  const double t = recording_.t;
  const auto raise_all = [&](std::vector<Peak>& peaks, const double* value) {
    for (std::size_t i = 0; i < peaks.size(); ++i) raise(peaks[i], value[i], t);
  };
  raise_all(recording_.lambda_peak, reaction_.lambda);
  raise_all(recording_.friction_peak, reaction_.friction);
  raise_all(recording_.drive_peak, reaction_.drive);
  for (std::size_t p = 0; p < recording_.pin_peak.size(); ++p) {
    raise(recording_.pin_peak[p], std::hypot(reaction_.pin[p].x, reaction_.pin[p].y), t);
  }
}

void Recorder::find_energies() {
  kinetic_ = stepper_.kinetic_energy(state_);
  potential_ = stepper_.potential_energy(state_);
  recording_.energy_final = kinetic_ + potential_;
  kinetic_most_ = std::fmax(kinetic_most_, kinetic_);
  potential_least_ = std::fmin(potential_least_, potential_);
  potential_most_ = std::fmax(potential_most_, potential_);
}

void Recorder::keep(bool row, bool kept) {
  if (!row && !kept) return;
  Sample now = sample();
  if (row) {
    csv_.write(io::csv_row(now));
    row_written_ = true;
  }
  if (kept) {
    recording_.samples.push_back(std::move(now));
    recording_.weakest.push_back(weakest_);
    weakest_ = Uniqueness::certified;
    sample_kept_ = true;
  }
}

Sample Recorder::sample() const {
  const auto& scene = recording_.file.scene;
  Sample s;
  s.t = recording_.t;
  s.q = values(state_.q, coordinates(scene), true);
  s.v = values(state_.v, coordinates(scene), true);
  s.lambda = values(reaction_.lambda, contacts(scene), reaction_known_);
  s.friction = values(reaction_.friction, scene.guides, reaction_known_);
  s.slip = values(reaction_.slip, scene.guides, reaction_known_);
  s.drive = values(reaction_.drive, scene.drives, reaction_known_);
  for (int g = 0; g < scene.guides; ++g) {
    const double slip = reaction_known_ ? reaction_.slip[g] : 0;
    const bool told = state_.decided && stepper_.source.tables.is_rough[g];
    s.mode.push_back(told ? state_.mode[g] : slip > 0 ? 1 : slip < 0 ? -1 : 0);
  }
  for (int p = 0; p < scene.pins; ++p) s.pin.push_back(reaction_known_ ? reaction_.pin[p] : Vec2{unknown, unknown});
  s.energy = kinetic_ + potential_;
  s.work = recording_.energy.work;
  s.dissipated = recording_.energy.dissipated;
  s.constraint_work = recording_.energy.constraint_work;
  s.drift = reaction_known_ ? reaction_.drift_position : unknown;
  return s;
}

}  // namespace slideway::app
