// What tests of stepping share: shipped scenes at run time, runs, and their events.
#pragma once

#include <gtest/gtest.h>

#include <slideway/io/stepper.hpp>
#include <string>
#include <vector>

namespace slideway::test {

using Room = io::RunSize;
using RunStepper = RunTimeStepper<Room>;
using RunState = RunStepper::State;

/// A shipped scene with settings PATH=VALUE.
inline Scene<Room> scene_of(const std::string& name, const std::vector<std::string>& settings = {}) {
  const auto reading = io::read_scene(SLIDEWAY_SOURCE_DIR "/scenes/" + name + ".toml", settings);
  for (const auto& defect : reading.defects) ADD_FAILURE() << to_string(defect);
  return reading.scene ? reading.scene->scene : Scene<Room>{};
}

inline RunStepper stepper_of(const std::string& name, Method method, const std::vector<std::string>& settings = {}) {
  RunStepper stepper(scene_of(name, settings));
  stepper.method = method;
  return stepper;
}

/// Methods for a scene that its drives do not move fully.
inline constexpr Method integrating[] = {Method::euler, Method::rk4, Method::rk4_located, Method::dop853_located,
                                         Method::moreau};
inline constexpr Method located[] = {Method::rk4_located, Method::dop853_located};

struct History {
  RunState state;
  std::vector<Event> events;  ///< located
  Report last;                ///< of the last step, made or refused
  long long unlocated = 0, evaluations = 0;
  Uniqueness uniqueness = Uniqueness::certified;
  EnergyFlow energy;
};

/// `steps` steps of dt, as far as they are made.
inline History run(const RunStepper& stepper, RunState state, double dt, long long steps) {
  History r{};
  r.state = state;
  for (long long k = 0; k < steps; ++k) {
    r.last = stepper.step(r.state, dt);
    if (r.last.status != Status::ok) break;
    r.events.insert(r.events.end(), r.last.event, r.last.event + r.last.events);
    r.unlocated += r.last.unlocated_events;
    r.evaluations += r.last.evaluations;
    r.uniqueness = weaker(r.uniqueness, r.last.uniqueness);
    add(r.energy, 1, r.last.energy);
  }
  return r;
}

inline double energy(const RunStepper& stepper, const RunState& state) {
  return stepper.kinetic_energy(state) + stepper.potential_energy(state);
}

}  // namespace slideway::test
