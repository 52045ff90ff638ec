// --set guide.slot.mu=0.3: one value of a parsed scene replaced before anything is checked.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <slideway/io/build.hpp>
#include <slideway/io/text.hpp>

namespace slideway::io {
namespace {

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t to = std::min(path.find('.', from), path.size());
    parts.emplace_back(path.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

/// The item of an array of tables that has the name, given or by default.
toml::table* find_item(toml::array& array, Item item, const std::string& name, std::vector<std::string>& names) {
  for (std::size_t i = 0; i < array.size(); ++i) {
    toml::table* table = array[i].as_table();
    if (table == nullptr) continue;
    names.push_back((*table)["name"].value_or(default_name(item, i)));
    if (names.back() == name) return table;
  }
  return nullptr;
}

/// The table that the last part of the path is a key of; a problem if there is none.
toml::table* find_table(toml::table& root, const std::vector<std::string>& path, std::string& problem) {
  if (path.size() == 1) return &root;
  if (path.size() == 2 && (path[0] == "run" || path[0] == "baumgarte")) {
    return root.emplace<toml::table>(path[0]).first->second.as_table();
  }
  const auto kind = std::find(std::next(std::begin(item_keys)), std::end(item_keys), path[0]);
  if (path.size() != 3 || kind == std::end(item_keys)) {
    problem = "must be KIND.NAME.KEY=VALUE, as in guide.slot.mu=0.3, or run.KEY=VALUE or baumgarte.KEY=VALUE";
    return nullptr;
  }
  std::vector<std::string> names;
  toml::array* array = root[path[0]].as_array();
  const auto item = static_cast<Item>(kind - std::begin(item_keys));
  toml::table* table = array != nullptr ? find_item(*array, item, path[1], names) : nullptr;
  if (table == nullptr)
    problem = fmt::format("there is no {} {}{}", path[0], quote(path[1]), suggestion(path[1], names));
  return table;
}

/// VALUE as TOML; a bare name is taken as a text, because a shell eats the quotes.
std::optional<toml::table> parse_value(const std::string& value, const std::string& option) {
  const std::string text = is_name(value) && value != "true" && value != "false" && value != "inf" && value != "nan"
                               ? '"' + value + '"'
                               : value;
  try {
    toml::table table = toml::parse("value = " + text, std::string_view{option});
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {  // said by the caller
  }
  return std::nullopt;
}

}  // namespace

void apply_setting(toml::table& root, const std::string& setting, std::vector<FileDefect>& problems) {
  const std::string option = "--set " + setting;
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    problems.push_back({option, 0, "must be PATH=VALUE, as in guide.slot.mu=0.3"});
    return;
  }
  const std::vector<std::string> path = split(std::string_view(setting).substr(0, equals));
  std::string problem;
  toml::table* table = find_table(root, path, problem);
  auto value = parse_value(setting.substr(equals + 1), option);
  if (table == nullptr) {
    problems.push_back({option, 0, problem});
  } else if (!value) {
    problems.push_back({option, 0, quote(setting.substr(equals + 1)) + " is not a TOML value"});
  } else {
    value->get("value")->visit([&](auto& node) { table->insert_or_assign(path.back(), std::move(node)); });
  }
}

}  // namespace slideway::io
