// [[body]], [[guide]], [[drive]], ... -> Scene: which tables there are, and their names.
#include <fmt/format.h>

#include <algorithm>
#include <slideway/io/build.hpp>
#include <slideway/io/text.hpp>

namespace slideway::io {
namespace {

enum class Name { required, optional };

/// The name of item i, with everything that can be wrong with a name.
void read_name(Build& build, Fields& fields, Item item, std::size_t i, Name name_is) {
  const bool given = name_is == Name::required || fields.has("name");
  if (!given) fields.know("name");
  const auto name = given ? fields.required_text("name") : default_name(item, i);
  std::vector<std::string>& taken = build.file.*names(item);
  if (name) {
    fields.rename(fmt::format("{} {}", item_key(item), quote(*name)));
    if (given && !is_name(*name)) {
      fields.defect("name", "needs a name made of letters, digits and _, not beginning with a digit");
    } else if (item == Item::body && *name == "ground") {
      fields.defect("name", "needs another name: \"ground\" is the world");
    } else if (std::find(taken.begin(), taken.end(), *name) != taken.end()) {
      fields.defect("name", "needs another name: an earlier one has it");
    }
  }
  taken.push_back(name.value_or(""));
}

/// The tables of [[key]], those beyond the room left out with a defect.
std::vector<const toml::table*> tables(Build& build, Item item, std::size_t room) {
  std::vector<const toml::table*> list;
  const toml::node* node = build.root.get(item_key(item));
  if (node == nullptr) return list;
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    build.problems.add(*node, fmt::format("{0} must be written as [[{0}]], once for each", item_key(item)));
    return list;
  }
  for (const toml::node& element : *array) list.push_back(element.as_table());
  if (list.size() > room) {
    build.problems.add(*list[room], fmt::format("scene needs at most {} of [[{}]], not {}: there is no room for more",
                                                room, item_key(item), list.size()));
    list.resize(room);
  }
  return list;
}

/// A body's name is known before any body is read, so that a parent that comes later is told as such.
void register_bodies(Build& build) {
  const toml::array* array = build.root["body"].as_array();
  if (array == nullptr) return;
  int i = 0;
  for (const toml::node& element : *array) {
    if (const toml::table* table = element.as_table()) {
      const std::string name = (*table)["name"].value_or(std::string{});
      if (!name.empty()) build.bodies.emplace(name, i);
    }
    ++i;
  }
}

template <class T, std::size_t N, class Read>
void read_kind(Build& build, Item item, T (&array)[N], int& count, Name name_is, Read read) {
  const auto list = tables(build, item, N);
  for (std::size_t i = 0; i < list.size(); ++i) {
    Fields fields(*list[i], fmt::format("{} {}", item_key(item), i + 1), build.problems);
    read_name(build, fields, item, i, name_is);
    array[i] = read(build, fields, static_cast<int>(i));
    fields.finish();
    build.file.lines[static_cast<std::size_t>(item)].push_back(static_cast<int>(list[i]->source().begin.line));
  }
  count = static_cast<int>(list.size());
}

}  // namespace

void read_items(Build& build) {
  Scene<RunSize>& scene = build.file.scene;
  register_bodies(build);
  read_kind(build, Item::body, scene.body, scene.bodies, Name::required, read_body);
  read_kind(build, Item::guide, scene.guide, scene.guides, Name::required, read_guide);
  read_kind(build, Item::drive, scene.drive, scene.drives, Name::required, read_drive);
  read_kind(build, Item::pin, scene.pin, scene.pins, Name::required, read_pin);
  read_kind(build, Item::spring, scene.spring, scene.springs, Name::optional, read_spring);
  read_kind(build, Item::joint_spring, scene.joint_spring, scene.joint_springs, Name::optional, read_joint_spring);
  read_kind(build, Item::load, scene.load, scene.loads, Name::optional, read_load);
  scene.inputs = static_cast<int>(build.file.input_names.size());
}

}  // namespace slideway::io
