// Trajectories as CSV: 17 significant digits, so that every double survives the way through the file.
#pragma once

#include <slideway/io/sample.hpp>
#include <slideway/io/scene_file.hpp>
#include <string>

namespace slideway::io {

/// t, q.BODY (planar: q.BODY.x .y .angle), v.BODY, lambda.GUIDE.K, friction.GUIDE, slip.GUIDE, mode.GUIDE, drive.NAME,
/// pin.NAME.x, pin.NAME.y, energy, work, dissipated, constraint_work, drift; with the line's end.
std::string csv_header(const SceneFile& file);

/// The same columns of one sample.
std::string csv_row(const Sample& sample);

}  // namespace slideway::io
