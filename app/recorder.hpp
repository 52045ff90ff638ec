// Watches a run: reactions, peaks, events and energies after every step; keeps samples and writes CSV rows.
#pragma once

#include "output.hpp"
#include "preparation.hpp"
#include "recording.hpp"

namespace slideway::app {

class Recorder {
 public:
  /// `planned`: the steps that the run is to make; rows of the CSV are the first, each `every`-th and the last.
  Recorder(const RunStepper& stepper, const RunInputs& inputs, long long planned, long long every, Output& csv,
           Recording& recording);

  /// The start. False when the kernel refuses to give its reactions.
  bool start(const RunState& state);
  /// The state after a step that was made, and the step's report. False as above.
  bool step(const RunState& state, const Report& report);
  /// A step from the last state was refused.
  void refuse(const Report& report);
  /// Writes the last row if it is not there yet.
  void finish();
  /// The instant that was seen last.
  Sample sample() const;

 private:
  bool observe(const RunState& state);
  void take_extremes(const Report& report);
  void find_events(const RunState& before, const RunState& now);
  void add_event(const Event& event);
  void follow_modes(const RunState& before, const Report& report, bool sampled);
  void find_peaks();
  void find_energies();
  void keep(bool row, bool sample);

  const RunStepper& stepper_;
  const RunInputs& inputs_;
  long long every_, stride_;
  Output& csv_;
  Recording& recording_;

  RunState state_;
  Reaction<io::RunSize> reaction_;
  bool reaction_known_ = false, row_written_ = true, sample_kept_ = true;
  Uniqueness weakest_ = Uniqueness::certified;  ///< since the sample that was kept last
  std::size_t mode_changes_ = 0;
  double kinetic_ = 0, potential_ = 0;
  double kinetic_most_ = 0, potential_least_ = 0, potential_most_ = 0;
};

/// What a refusal means, in a sentence that names the guide if there is one.
std::string explain(const Recording& recording, const Report& report);

}  // namespace slideway::app
