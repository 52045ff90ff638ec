// Is the start of a scene one that its constraints allow, with a mass matrix that can be solved?
#pragma once

#include <slideway/io/scene_file.hpp>
#include <vector>

namespace slideway::io {

/// Largest miss of a constraint at the start, in lengths of the scene; of its rate, in largest speeds.
inline constexpr double start_tolerance = 1e-9;

/// The undriven mass matrix must be definite: otherwise the body whose coordinate lacks inertia is named.
std::vector<FileDefect> check_masses(const SceneFile& file);

/// Guides and pins that the start misses by more than the tolerance, each with the miss.
std::vector<FileDefect> check_start(const SceneFile& file);

}  // namespace slideway::io
