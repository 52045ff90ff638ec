#include <slideway/io/json.hpp>

namespace slideway::io {
namespace {

/// Takes `count` values from `next` on.
Json take(const std::vector<double>& values, std::size_t& next, int count) {
  Json list = Json::array();
  for (int k = 0; k < count && next < values.size(); ++k) list.push_back(values[next++]);
  return list;
}

}  // namespace

Json document(const SceneFile& file) {
  Json json{{"format", json_format}, {"version", SLIDEWAY_VERSION}, {"scene", file.name}, {"hash", file.hash}};
  if (!file.settings.empty()) json["settings"] = file.settings;
  return json;
}

Json by_body(const SceneFile& file, const std::vector<double>& values) {
  Json json = Json::object();
  std::size_t next = 0;
  for (std::size_t i = 0; i < file.body_names.size(); ++i) {
    json[file.body_names[i]] = take(values, next, coordinates(file.scene.body[i].joint));
  }
  return json;
}

Json by_contact(const SceneFile& file, const std::vector<double>& values) {
  Json json = Json::object();
  std::size_t next = 0;
  for (std::size_t g = 0; g < file.guide_names.size(); ++g) {
    json[file.guide_names[g]] = take(values, next, file.scene.guide[g].contacts);
  }
  return json;
}

Json by_name(const std::vector<std::string>& names, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < names.size() && i < values.size(); ++i) json[names[i]] = values[i];
  return json;
}

Json by_name(const std::vector<std::string>& names, const std::vector<Vec2>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < names.size() && i < values.size(); ++i) {
    json[names[i]] = Json::array({values[i].x, values[i].y});
  }
  return json;
}

std::string text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

}  // namespace slideway::io
