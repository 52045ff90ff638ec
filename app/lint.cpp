// slideway lint: what a scene models beyond need, and what leaving it out would change.
#include <algorithm>
#include <memory>
#include <slideway/io/json.hpp>
#include <slideway/structure.hpp>

#include "lint_trials.hpp"
#include "messages.hpp"
#include "output.hpp"
#include "scene_source.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

/// The rules. Each is a statement that follows from the scene's structure, not from numbers that a start pose happens
/// to have.
class Linter {
 public:
  explicit Linter(const io::SceneFile& file) : scene_(file.scene), table_(derive(file.scene)) {}

  std::vector<Remark> remarks() && {
    for (int i = 0; i < scene_.bodies; ++i) look_at_body(i);
    for (int g = 0; g < scene_.guides; ++g) look_at_guide(g);
    for (int p = 0; p < scene_.pins; ++p) look_at_pin(p);
    look_at_forces();
    return std::move(remarks_);
  }

 private:
  using Tables = slideway::Tables<io::RunSize>;
  using Link = slideway::Link<io::RunSize>;

  void add(Item item, int index, const char* message) { remarks_.push_back({item, index, message}); }

  bool is_parent(int i) const {
    return std::any_of(scene_.body, scene_.body + scene_.bodies, [&](const Body& body) { return body.parent == i; });
  }

  /// Guides, pins, springs and loads on a body.
  bool is_used(int i) const {
    const auto any = [&](const auto* items, int count, auto uses) { return std::any_of(items, items + count, uses); };
    const auto joins = [&](const auto& item) { return item.a == i || item.b == i; };
    const auto acts = [&](const auto& item) { return item.body == i; };
    return any(scene_.guide, scene_.guides, [&](const Guide& guide) { return guide.slider == i || guide.rail == i; }) ||
           any(scene_.pin, scene_.pins, joins) || any(scene_.spring, scene_.springs, joins) ||
           any(scene_.joint_spring, scene_.joint_springs, acts) || any(scene_.load, scene_.loads, acts);
  }

  void look_at_body(int i) {
    const Body& body = scene_.body[i];
    const bool idle = !is_parent(i) && !is_used(i);
    if (idle && body.mass == 0 && body.inertia == 0) {
      add(Item::body, i, "has no mass and carries nothing: without it, and a drive of it, all else stays as it is");
    } else if (idle && body.joint == Joint::fixed && body.parent == ground) {
      add(Item::body, i,
          "is fixed to the ground and carries nothing: without it nothing changes but the energy's zero");
    } else if (idle && body.joint == Joint::fixed) {
      add(Item::body, i, "is fixed to its parent: its mass in the parent gives the same motion with one body less");
    }
    if (body.inertia != 0 && !table_.turning[i]) {
      add(Item::body, i, "never turns: its inertia has no effect, and inertia = 0 gives the same run");
    }
  }

  template <class Test>
  bool any_free(const Link& link, Test test) const {
    return std::any_of(link.column, link.column + link.columns,
                       [&](Index j) { return table_.free_of[j] != none && test(j); });
  }
  bool any_free(const Link& link) const {
    return any_free(link, [](Index) { return true; });
  }

  void look_at_guide(int g) {
    const Guide& guide = scene_.guide[g];
    const Link& link = table_.guide[g];
    const Vec2 *a = &guide.contact[0], *b = &guide.contact[1];
    if (!any_free(link)) {
      add(Item::guide, g,
          "joins bodies that only drives move against each other: it is redundant, and a run is refused");
    } else if (guide.contacts == 2 && a->x == b->x && a->y == b->y) {
      add(Item::guide, g, "has its two contacts in one place: one is redundant, and a run is refused");
    } else if (guide.contacts == 2 && !any_free(link, [&](Index j) { return table_.motion[j] == Motion::turn; })) {
      add(Item::guide, g,
          "has two contacts, but its slider is not free to turn against the rail: one is redundant, and a run is "
          "refused");
    } else if (guide.mu > 0 && friction_only_loads_drives(guide, link)) {
      add(Item::guide, g,
          "has friction that only its drives feel: mu = 0 gives the same motion and contact forces, and other drive "
          "forces");
    }
  }

  /// The one free coordinate turns the rail about its origin, and that lies on the line: friction has no arm.
  bool friction_only_loads_drives(const Guide& guide, const Link& link) const {
    const Vec2 origin = guide.origin, along = guide.tangent;
    const bool through_joint = origin.x * along.y == origin.y * along.x;
    const bool only_rail = !any_free(link, [&](Index j) {
      return table_.body_of[j] != guide.rail || scene_.body[guide.rail].joint != Joint::revolute;
    });
    return through_joint && only_rail;
  }

  void look_at_pin(int p) {
    if (!any_free(table_.pin[p])) {
      add(Item::pin, p, "joins bodies that only drives move against each other: it is redundant, and a run is refused");
    }
  }

  void look_at_forces() {
    for (int s = 0; s < scene_.springs; ++s) {
      if (scene_.spring[s].stiffness == 0 && scene_.spring[s].damping == 0) {
        add(Item::spring, s, "has neither stiffness nor damping: without it nothing changes");
      }
    }
    for (int s = 0; s < scene_.joint_springs; ++s) {
      const JointSpring& spring = scene_.joint_spring[s];
      if (spring.stiffness == 0 && spring.damping == 0) {
        add(Item::joint_spring, s, "has neither stiffness nor damping: without it nothing changes");
      } else if (table_.drive_of[table_.first[spring.body]] != none) {
        add(Item::joint_spring, s, "acts on a driven coordinate: without it only the drive's force changes");
      }
    }
    for (int l = 0; l < scene_.loads; ++l) {
      const Load& load = scene_.load[l];
      if (load.force.x == 0 && load.force.y == 0 && load.torque == 0) {
        add(Item::load, l, "is zero: without it nothing changes");
      }
    }
  }

  const Scene<io::RunSize>& scene_;
  Tables table_;
  std::vector<Remark> remarks_;
};

io::Json lint_document(const io::SceneFile& file, const std::vector<Remark>& remarks) {
  io::Json json = io::document(file);
  json["findings"] = io::Json::array();
  for (const Remark& remark : remarks) {
    json["findings"].push_back({{"item", file.title(remark.item, remark.index)},
                                {"line", file.line(remark.item, remark.index)},
                                {"message", remark.message}});
  }
  return json;
}

struct LintOptions {
  SceneOptions scene;
  std::string json;
};

int lint(const LintOptions& options) {
  const auto file = load_scene(options.scene.scene, options.scene.settings, Start::checked);
  if (!file) return bad_input;
  Output json(options.json);
  if (!open_all({&json}, options.scene.scene)) return bad_input;
  std::vector<Remark> remarks = Linter(*file).remarks();
  for (Remark& tried : remarks_by_trial(*file, remarks)) remarks.push_back(std::move(tried));
  std::FILE* const out = json.standard() ? stderr : stdout;
  for (const Remark& remark : remarks) {
    const std::string message = file->title(remark.item, remark.index) + " " + remark.message;
    fmt::print(out, "{}\n", to_string(io::FileDefect{file->file, file->line(remark.item, remark.index), message}));
  }
  if (remarks.empty()) fmt::print(out, "{}: models nothing beyond need, as far as lint can tell\n", file->file);
  json.write(io::text(lint_document(*file, remarks)));
  return json.close() ? good : bad_input;
}

}  // namespace

void add_lint(CLI::App& command, int& status) {
  const auto options = std::make_shared<LintOptions>();
  CLI::App* verb = command.add_subcommand("lint", "Tell what a scene models beyond need");
  add_scene_options(*verb, options->scene);
  verb->add_option("--json", options->json, "Write the findings as JSON; - is standard output");
  verb->callback([options, &status] { status = lint(*options); });
}

}  // namespace slideway::app
