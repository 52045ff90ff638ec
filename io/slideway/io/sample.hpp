// Instants and events of a run, as files and charts show them.
#pragma once

#include <slideway/state.hpp>
#include <vector>

namespace slideway::io {

/// Vectors have the scene's own lengths and order; see Reaction for signs and units.
struct Sample {
  double t = 0;
  std::vector<double> q, v;      ///< per coordinate, body by body: revolute and prismatic 1, planar 3, fixed 0
  std::vector<double> lambda;    ///< per contact, guide by guide, N
  std::vector<double> friction;  ///< per guide, on the slider along its tangent, N
  std::vector<double> slip;      ///< per guide, sliding speed, m/s
  std::vector<int> mode;         ///< per guide: -1, 0, 1
  std::vector<double> drive;     ///< per drive, N m | N
  std::vector<Vec2> pin;         ///< per pin, on body a, world's frame, N
  double energy = 0;             ///< kinetic + potential, J
  double work = 0, dissipated = 0, constraint_work = 0;  ///< since the start, J
  double drift = 0;                                      ///< max |Phi|, |phi|
};

}  // namespace slideway::io
