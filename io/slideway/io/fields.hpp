// A TOML table read key by key: every wrong type, missing key and unknown key becomes a defect with its line.
#pragma once

#include <toml++/toml.h>
#include <initializer_list>
#include <optional>
#include <slideway/io/scene_file.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace slideway::io {

/// What is wrong so far.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  /// At the node's line; a node that came from a `--set` option names the option instead.
  void add(const toml::node& where, std::string message);
  void add(int line, std::string message) { defects_.push_back({file_, line, std::move(message)}); }
  bool empty() const noexcept { return defects_.empty(); }
  std::vector<FileDefect> sorted() &&;

 private:
  std::string file_;
  std::vector<FileDefect> defects_;
};

class Fields {
 public:
  /// `title` names the item in messages: "guide 'slot'".
  Fields(const toml::table& table, std::string title, Problems& problems);

  // A value of the wrong type is a defect, and reads as absent without a second one.
  std::optional<double> number(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  std::optional<Vec2> vec2(std::string_view key);
  std::optional<std::vector<double>> numbers(std::string_view key);
  std::optional<std::vector<Vec2>> points(std::string_view key);
  /// The position of the text among `choices`.
  std::optional<int> choice(std::string_view key, const std::vector<std::string>& choices);

  /// Whether the key is there; a defect that shows `example` if not.
  bool require(std::string_view key, std::string_view example);
  double required_number(std::string_view key);
  std::optional<std::string> required_text(std::string_view key);
  int required_choice(std::string_view key, const std::vector<std::string>& choices);

  /// A key that another reader takes care of.
  void know(std::string_view key);
  /// Reports every key that nobody asked for.
  void finish();

  /// "guide 'slot' " + message, at the key's line, else at the table's.
  void defect(std::string_view key, const std::string& message);
  bool has(std::string_view key) const { return table_.contains(key); }
  const std::string& title() const noexcept { return title_; }
  void rename(std::string title) { title_ = std::move(title); }

 private:
  const toml::node* find(std::string_view key);
  void wrong(const toml::node& node, std::string_view key, std::string_view wanted);

  const toml::table& table_;
  std::string title_;
  Problems& problems_;
  std::vector<std::string> known_;
};

}  // namespace slideway::io
