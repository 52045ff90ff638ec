// The oracle's model of what a command prepared. Apart from verification.hpp, which needs no multiprecision.
#pragma once

#include <slideway/oracle/trajectory.hpp>

#include "verification.hpp"

namespace slideway::app {

/// With the inputs, the gains and the start that the kernel has. Where projection keeps the constraints, gains are
/// zero.
inline oracle::Model<oracle::Real> model_of(const Preparation& prepared) {
  auto model = oracle::model_of<oracle::Real>(prepared.recording.file.scene, prepared.recording.input_values);
  const bool projects = prepared.stepper->stabilise == Stabilise::projection;
  model.alpha = projects ? 0 : prepared.recording.alpha;
  model.beta = projects ? 0 : prepared.recording.beta;
  for (std::size_t j = 0; j < model.start.q.size(); ++j) {
    model.start.q[j] = prepared.start.q[j];
    model.start.v[j] = prepared.start.v[j];
  }
  return model;
}

}  // namespace slideway::app
