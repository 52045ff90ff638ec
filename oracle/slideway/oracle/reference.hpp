// References: trajectories of scenes, kept as data with the digits that they are good for.
#pragma once

#include <slideway/io/json.hpp>
#include <slideway/oracle/trajectory.hpp>
#include <string>

namespace slideway::oracle {

/// A trajectory at equally spaced times from 0 to the scene's own duration, and how good it is.
struct Reference {
  std::string scene, hash;  ///< name, and hash of the text it was made from
  double duration = 0;      ///< s
  double digits = 0;        ///< decimal digits that two runs of different order and step share in every number
  Trajectory<Real> trajectory;
};

/// Intervals between a reference's samples.
inline constexpr int reference_intervals = 16;

Reference make_reference(const io::SceneFile& scene, const std::function<void(double)>& progress);

/// To and from JSON: numbers as text with 32 digits, and a checksum over all that is before it.
io::Json to_json(const Reference& reference);
/// runtime_error with one line if the document is not one that to_json() made.
Reference reference_of(const io::Json& json);

}  // namespace slideway::oracle
