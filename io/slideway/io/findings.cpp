// What the kernel finds wrong with a scene's data, told in the file's terms.
#include <fmt/format.h>

#include <cmath>
#include <slideway/io/build.hpp>
#include <slideway/io/text.hpp>

namespace slideway::io {
namespace {

/// The key that a defect is about; empty if it is about no single one.
std::string_view key_of(Defect defect) {
  switch (defect) {
    case Defect::parent_not_earlier:
      return "parent";
    case Defect::negative_mass:
      return "mass";
    case Defect::negative_inertia:
      return "inertia";
    case Defect::contact_count:
      return "contacts";
    case Defect::no_direction:
      return "direction";
    case Defect::negative_mu:
      return "mu";
    case Defect::mu_static_below_mu:
      return "mu_static";
    case Defect::negative_viscous:
      return "viscous";
    case Defect::negative_preload:
      return "preload";
    case Defect::no_such_coordinate:
    case Defect::driven_twice:
      return "body";
    case Defect::coefficient_count:
      return "coefficients";
    case Defect::negative_stiffness:
      return "stiffness";
    case Defect::negative_length:
      return "length";
    case Defect::negative_damping:
      return "damping";
    default:
      return {};
  }
}

const toml::table& table_of(const Build& build, const Finding& finding) {
  if (finding.item == Item::scene) return build.root;
  return *build.root[item_key(finding.item)][static_cast<std::size_t>(finding.index)].as_table();
}

/// ": mu = -0.2" for a number or a text, so that the reader sees what is meant.
std::string shown(const toml::node& node, std::string_view key) {
  if (const auto* real = node.as_floating_point()) return fmt::format(": {} = {}", key, real->get());
  if (const auto* integer = node.as_integer()) return fmt::format(": {} = {}", key, integer->get());
  if (const auto* text = node.as_string()) return fmt::format(": {} = {}", key, quote(text->get()));
  return {};
}

/// A finding about an item of which something was not understood, and this has been said.
bool told_already(const Build& build, const Finding& finding) {
  switch (finding.defect) {
    case Defect::no_such_body:
    case Defect::no_such_input:
    case Defect::same_body:
    case Defect::parent_not_earlier:
    case Defect::no_such_coordinate:
    case Defect::driven_twice:
      return build.unresolved.contains({finding.item, finding.index});
    default:
      return false;
  }
}

/// Every number below `node` that is not finite.
void add_not_finite(Build& build, const toml::node& node, const std::string& message, std::string_view key) {
  if (const auto* value = node.as_floating_point(); value != nullptr && !std::isfinite(value->get())) {
    build.problems.add(node, message + shown(node, key));
  }
  if (const auto* array = node.as_array()) {
    for (const toml::node& element : *array) add_not_finite(build, element, message, key);
  }
}

void add_finding(Build& build, const Finding& finding) {
  const std::string message = build.file.title(finding.item, finding.index) + " " + sentence(finding.defect);
  const toml::table* baumgarte = build.root["baumgarte"].as_table();
  const bool of_scene = finding.item == Item::scene;
  const toml::table& table = table_of(build, finding);
  if (finding.defect == Defect::too_large) {
    build.problems.add(table, fmt::format("{}: {} coordinates and {} contacts at most", message, RunSize::coordinates,
                                          RunSize::contacts));
  } else if (finding.defect == Defect::not_finite) {
    for (const auto& [key, node] : table) add_not_finite(build, node, message, key.str());
    if (!of_scene || baumgarte == nullptr) return;
    for (const auto& [key, node] : *baumgarte) add_not_finite(build, node, message, key.str());
  } else if (of_scene && baumgarte != nullptr) {
    build.problems.add(*baumgarte, message);
  } else if (const toml::node* value = table.get(key_of(finding.defect))) {
    build.problems.add(*value, message + shown(*value, key_of(finding.defect)));
  } else {
    build.problems.add(table, message);
  }
}

}  // namespace

void add_findings(Build& build) {
  const Findings found = defects(build.file.scene);
  for (int i = 0; i < found.count && i < Findings::room; ++i) {
    if (!told_already(build, found.finding[i])) add_finding(build, found.finding[i]);
  }
  if (found.count > Findings::room) {
    build.problems.add(build.root, fmt::format("scene has {} more defects", found.count - Findings::room));
  }
}

}  // namespace slideway::io
