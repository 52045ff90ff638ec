// What reading a scene works on; internal to the reader.
#pragma once

#include <map>
#include <set>
#include <slideway/io/fields.hpp>
#include <string>
#include <utility>

namespace slideway::io {

struct Build {
  const toml::table& root;
  Problems& problems;
  SceneFile& file;
  std::map<std::string, int> bodies;          ///< name -> index, those beyond the room included
  std::set<std::pair<Item, int>> unresolved;  ///< items that name a body or input which does not exist: already said
};

/// The keys of the arrays of tables, in the order of Item.
inline constexpr std::string_view item_keys[] = {"", "body", "guide", "drive", "pin", "spring", "joint_spring", "load"};
constexpr std::string_view item_key(Item item) { return item_keys[static_cast<int>(item)]; }

/// The name an item has if it does not give one: spring1, spring2, ...
std::string default_name(Item item, std::size_t index);

/// The names of all items of a kind.
std::vector<std::string> SceneFile::*names(Item item);

// One table of a kind, the i-th -> one item. Names and unknown keys are the caller's.
Body read_body(Build& build, Fields& fields, int i);
Guide read_guide(Build& build, Fields& fields, int i);
Drive read_drive(Build& build, Fields& fields, int i);
Pin read_pin(Build& build, Fields& fields, int i);
Spring read_spring(Build& build, Fields& fields, int i);
JointSpring read_joint_spring(Build& build, Fields& fields, int i);
Load read_load(Build& build, Fields& fields, int i);

/// Reads every item of root into the scene. What slideway::defects() sees is not checked here.
void read_items(Build& build);

/// Adds slideway::defects(scene), each at the line of the key that it is about.
void add_findings(Build& build);

/// Puts every driven coordinate of a scene without defects on its law at t = 0; one with law = "input" keeps its start.
void start_on_laws(Scene<RunSize>& scene);

/// Applies PATH=VALUE to a parsed scene; says what is wrong with it through `problems`.
void apply_setting(toml::table& root, const std::string& setting, std::vector<FileDefect>& problems);

}  // namespace slideway::io
