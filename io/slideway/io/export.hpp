// A scene as a constexpr C++17 header, for embedding.
#pragma once

#include <slideway/io/scene_file.hpp>
#include <string>

namespace slideway::io {

/// Whether C++ takes the scene's name as the name of a variable; if not, what to do about it.
std::string export_problem(const SceneFile& file);

/// The header: `inline constexpr slideway::Scene<...> NAME`, exactly as large as the scene is and bit for bit its data,
/// and `namespace NAME_index` with the index of every named thing.
std::string export_header(const SceneFile& file);

}  // namespace slideway::io
