// What a run leaves behind in memory: written by `run`, read by the table, the JSON document and the HTML report.
#pragma once

#include <slideway/io/sample.hpp>
#include <slideway/io/scene_file.hpp>
#include <slideway/state.hpp>
#include <string>
#include <vector>

namespace slideway::app {

using io::Sample;

/// The value of largest magnitude over all steps and when it was reached.
struct Peak {
  double value = 0;
  double t = 0;
};

/// A guide's mode from t on, until the next one begins.
struct ModeSpan {
  double t = 0;
  int mode = 0;  ///< as in State
};

struct Recording {
  io::SceneFile file;  ///< scene, names, hash, settings

  std::string method;
  double dt = 0, duration = 0;
  bool located = false;              ///< by this method, events have times of their own
  double alpha = 0, beta = 0;        ///< Baumgarte, 1/s and 1/s^2
  std::string stabilise;             ///< baumgarte or projection
  double theta = 0;                  ///< of moreau
  std::vector<double> input_values;  ///< constant over the run, in the order of file.input_names

  std::vector<Sample>
      samples;  ///< first, every so many steps, last; about 2000 at most; empty if the start was refused
  std::vector<Uniqueness> weakest;  ///< of each sample: all that was decided since the one before
  std::vector<Event> events;        ///< the first `most_events`
  static constexpr std::size_t most_events = 10000;
  long long events_left_out = 0;
  /// Per guide, none without friction. After `most_events` changes only as samples show them.
  std::vector<std::vector<ModeSpan>> modes;

  Status status = Status::ok;
  std::string message;                            ///< what the command prints when status is not ok
  int guide = none;                               ///< the guide that a refusal is about
  long long steps = 0;                            ///< made
  double t = 0;                                   ///< reached, s
  Uniqueness uniqueness = Uniqueness::certified;  ///< the weakest over the run
  double drift_position = 0, drift_velocity = 0;  ///< maxima
  double residual = 0;                            ///< maximum, in units of its rounding scale
  int solves_max = 0;                             ///< per HLCP call
  long long unlocated_events = 0;
  double ns_per_step = 0;  ///< of step() alone

  std::vector<Peak> lambda_peak, friction_peak, drive_peak, pin_peak;  ///< pin: magnitude

  double energy_initial = 0, energy_final = 0;
  EnergyFlow energy;          ///< since the start
  double energy_in_play = 0;  ///< max kinetic + range of potential + |work|
  double energy_miss() const noexcept {
    return energy_final - energy_initial - (energy.work - energy.dissipated + energy.constraint_work);
  }
};

}  // namespace slideway::app
