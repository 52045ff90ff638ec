#include <fmt/format.h>

#include <algorithm>
#include <slideway/io/fields.hpp>
#include <slideway/io/text.hpp>

namespace slideway::io {
namespace {

std::optional<double> as_number(const toml::node& node) {
  if (const auto* real = node.as_floating_point()) return real->get();
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  return std::nullopt;
}

std::optional<Vec2> as_vec2(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 2) return std::nullopt;
  const auto x = as_number((*array)[0]), y = as_number((*array)[1]);
  if (!x || !y) return std::nullopt;
  return Vec2{*x, *y};
}

std::string joined(const std::vector<std::string>& choices) {
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "\"" : " | \"") + choice + "\"";
  return list;
}

}  // namespace

void Problems::add(const toml::node& where, std::string message) {
  const toml::source_region& source = where.source();
  if (source.path) {
    defects_.push_back({*source.path, 0, std::move(message)});
  } else {
    add(static_cast<int>(source.begin.line), std::move(message));
  }
}

std::vector<FileDefect> Problems::sorted() && {
  std::stable_sort(defects_.begin(), defects_.end(),
                   [](const FileDefect& a, const FileDefect& b) { return a.line < b.line; });
  const auto same = [](const FileDefect& a, const FileDefect& b) {
    return a.file == b.file && a.line == b.line && a.message == b.message;
  };
  defects_.erase(std::unique(defects_.begin(), defects_.end(), same), defects_.end());
  return std::move(defects_);
}

Fields::Fields(const toml::table& table, std::string title, Problems& problems)
    : table_(table), title_(std::move(title)), problems_(problems) {}

void Fields::know(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
}

const toml::node* Fields::find(std::string_view key) {
  know(key);
  return table_.get(key);
}

void Fields::defect(std::string_view key, const std::string& message) {
  const toml::node* node = table_.get(key);
  problems_.add(node != nullptr ? *node : table_, title_ + " " + message);
}

void Fields::wrong(const toml::node& node, std::string_view key, std::string_view wanted) {
  problems_.add(node, fmt::format("{}: {} must be {}", title_, key, wanted));
}

bool Fields::require(std::string_view key, std::string_view example) {
  if (table_.contains(key)) return true;
  know(key);
  problems_.add(table_, fmt::format("{} needs {} = {}", title_, key, example));
  return false;
}

std::optional<double> Fields::number(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = as_number(*node);
  if (!value) wrong(*node, key, "a number");
  return value;
}

std::optional<std::string> Fields::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* value = node->as_string()) return value->get();
  wrong(*node, key, "a text in quotes");
  return std::nullopt;
}

std::optional<Vec2> Fields::vec2(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = as_vec2(*node);
  if (!value) wrong(*node, key, "two numbers: [x, y]");
  return value;
}

std::optional<std::vector<double>> Fields::numbers(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  std::vector<double> values;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    if (const auto value = as_number((*array)[i])) values.push_back(*value);
  }
  if (array != nullptr && values.size() == array->size()) return values;
  wrong(*node, key, "numbers in brackets: [1.0, 2.0]");
  return std::nullopt;
}

std::optional<std::vector<Vec2>> Fields::points(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  std::vector<Vec2> values;
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    if (const auto value = as_vec2((*array)[i])) values.push_back(*value);
  }
  if (array != nullptr && values.size() == array->size()) return values;
  wrong(*node, key, "points in brackets: [[x, y], [x, y]]");
  return std::nullopt;
}

std::optional<int> Fields::choice(std::string_view key, const std::vector<std::string>& choices) {
  const auto value = text(key);
  if (!value) return std::nullopt;
  const auto found = std::find(choices.begin(), choices.end(), *value);
  if (found != choices.end()) return static_cast<int>(found - choices.begin());
  problems_.add(*table_.get(key),
                fmt::format("{}: {} must be {}, not {}", title_, key, joined(choices), quote(*value)));
  return std::nullopt;
}

double Fields::required_number(std::string_view key) { return require(key, "a number") ? number(key).value_or(0) : 0; }

std::optional<std::string> Fields::required_text(std::string_view key) {
  return require(key, "\"...\"") ? text(key) : std::nullopt;
}

int Fields::required_choice(std::string_view key, const std::vector<std::string>& choices) {
  return require(key, joined(choices)) ? choice(key, choices).value_or(-1) : -1;
}

void Fields::finish() {
  for (const auto& [key, node] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    problems_.add(node, fmt::format("{}: unknown key {}{}", title_, quote(key.str()), suggestion(key.str(), known_)));
  }
}

}  // namespace slideway::io
