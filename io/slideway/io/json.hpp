// What all JSON documents share. Numbers are written with as many digits as give the same double back; what is not
// finite is null.
#pragma once

#include <nlohmann/json.hpp>
#include <slideway/io/scene_file.hpp>
#include <string>

namespace slideway::io {

using Json = nlohmann::ordered_json;

/// Of the documents that docs/schema describes; raised when one of them changes its meaning.
inline constexpr int json_format = 1;

/// {format, version, scene, hash} and, if there are any, the settings.
Json document(const SceneFile& file);

/// {BODY: [..]} of values that lie body by body; a fixed body has an empty list.
Json by_body(const SceneFile& file, const std::vector<double>& values);

/// {GUIDE: [..]} of values that lie contact by contact.
Json by_contact(const SceneFile& file, const std::vector<double>& values);

/// {NAME: x}
Json by_name(const std::vector<std::string>& names, const std::vector<double>& values);

/// {NAME: [x, y]}
Json by_name(const std::vector<std::string>& names, const std::vector<Vec2>& values);

/// The document's text, with the line's end.
std::string text(const Json& json);

}  // namespace slideway::io
