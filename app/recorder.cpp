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

}  // namespace

std::string explain(const Recording& recording, const Report& report) {
  if (report.guide == none) return sentence(report.status);
  const std::string guide = recording.file.title(Item::guide, report.guide);
  if (report.status == Status::invalid_input) {
    return guide + " is at rest, which this version does not model: let it slide from the start.";
  }
  return fmt::format("{} ({})", sentence(report.status), guide);
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
  csv_.write(csv_header(file));
}

bool Recorder::start(const RunState& state) {
  kinetic_most_ = stepper_.kinetic_energy(state);
  potential_least_ = potential_most_ = stepper_.potential_energy(state);
  recording_.energy_initial = kinetic_most_ + potential_least_;
  const bool known = observe(state);
  keep(true, true);
  return known;
}

bool Recorder::step(const RunState& state, const Report& report) {
  ++recording_.steps;
  take_extremes(report);
  recording_.unlocated_events += report.unlocated_events;
  recording_.energy.work += report.energy.work;
  recording_.energy.dissipated += report.energy.dissipated;
  recording_.energy.constraint_work += report.energy.constraint_work;
  find_events(state_, state);
  const bool known = observe(state);
  keep(recording_.steps % every_ == 0, recording_.steps % stride_ == 0);
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
  recording_.solves_max = std::max(recording_.solves_max, report.solves);
  recording_.residual = std::fmax(recording_.residual, report.residual);
  recording_.drift_position = std::fmax(recording_.drift_position, report.drift_position);
  recording_.drift_velocity = std::fmax(recording_.drift_velocity, report.drift_velocity);
}

void Recorder::add_event(const RunState& now, int guide, int contact, EventKind kind) {
  if (recording_.events.size() < Recording::most_events) {
    recording_.events.push_back({now.time(), guide, contact, kind});
  } else {
    ++recording_.events_left_out;
  }
}

void Recorder::find_events(const RunState& before, const RunState& now) {
  if (recording_.steps == 1) return;  // the first step finds the slip directions and signs
  const auto& scene = recording_.file.scene;
  for (int g = 0, c = 0; g < scene.guides; ++g) {
    const int was = before.mode[g], is = now.mode[g];
    if (was != is) {
      add_event(now, g, none, is == 0 ? EventKind::stick : was == 0 ? EventKind::slip : EventKind::slip_reversal);
    }
    for (int k = 0; k < scene.guide[g].contacts; ++k, ++c) {
      if (before.sign[c] != now.sign[c]) add_event(now, g, k, EventKind::normal_reversal);
    }
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
    s.mode.push_back(slip > 0 ? 1 : slip < 0 ? -1 : state_.mode[g]);
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
