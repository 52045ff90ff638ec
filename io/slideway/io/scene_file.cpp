#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <slideway/io/build.hpp>
#include <slideway/io/text.hpp>
#include <slideway/method.hpp>

namespace slideway::io {
namespace {

/// More dots than this in one line are nested tables so deep that their destruction would overflow the stack.
constexpr std::ptrdiff_t most_dots = 200;

constexpr std::size_t most_of_error = 200;  ///< of the parser's, which quotes what it read

/// What no TOML parser should be given; the line is 0 for the text as a whole.
std::optional<FileDefect> refuse(std::string_view text, const std::string& file) {
  if (text.size() > largest_text) return FileDefect{file, 0, "is longer than 1 MiB, too much for a scene"};
  if (std::all_of(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; })) {
    return FileDefect{file, 0, "is empty: a scene needs a name and at least one [[body]]"};
  }
  int number = 1;
  for (std::size_t from = 0; from < text.size(); ++number) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    const std::string_view line = text.substr(from, to - from);
    if (line.find('\0') != line.npos) return FileDefect{file, number, "is binary: a scene is a TOML text"};
    if (std::count(line.begin(), line.end(), '.') > most_dots) return FileDefect{file, number, "is nested too deep"};
    from = to + 1;
  }
  return std::nullopt;
}

/// The table of a key that may be absent.
const toml::table* subtable(Build& build, std::string_view key) {
  const toml::node* node = build.root.get(key);
  if (node != nullptr && !node->is_table()) build.problems.add(*node, fmt::format("{0} must be a table: [{0}]", key));
  return node != nullptr ? node->as_table() : nullptr;
}

void read_baumgarte(Build& build) {
  const toml::table* table = subtable(build, "baumgarte");
  if (table == nullptr) return;
  Fields fields(*table, "baumgarte", build.problems);
  Scene<RunSize>& scene = build.file.scene;
  scene.alpha = fields.number("alpha").value_or(scene.alpha);
  scene.beta = fields.number("beta").value_or(scene.beta);
  fields.finish();
}

void read_run(Build& build) {
  const toml::table* table = subtable(build, "run");
  if (table == nullptr) return;
  Fields fields(*table, "run", build.problems);
  RunDefaults& run = build.file.run;
  if (const auto method = fields.choice("method", methods())) run.method = methods()[static_cast<std::size_t>(*method)];
  run.dt = fields.number("dt").value_or(run.dt);
  run.duration = fields.number("duration").value_or(run.duration);
  if (!(run.dt > 0) || !std::isfinite(run.dt)) fields.defect("dt", "needs dt > 0, in seconds");
  if (!(run.duration > 0) || !std::isfinite(run.duration)) fields.defect("duration", "needs duration > 0, in seconds");
  fields.finish();
}

void read_scene_fields(Build& build) {
  Fields fields(build.root, "scene", build.problems);
  const auto name = fields.required_text("name");
  build.file.name = name.value_or("");
  if (name && !is_name(*name)) {
    fields.defect("name", "needs a name made of letters, digits and _, not beginning with a digit");
  }
  build.file.scene.gravity = fields.vec2("gravity").value_or(Vec2{});
  if (!fields.has("body")) fields.defect("body", "needs at least one [[body]]");
  for (const std::string_view key : item_keys) {
    if (!key.empty()) fields.know(key);
  }
  fields.know("baumgarte");
  fields.know("run");
  fields.finish();
}

}  // namespace

const std::vector<std::string>& methods() {
  static const std::vector<std::string> list = [] {
    std::vector<std::string> names;
    for (const Method method : slideway::methods) names.emplace_back(name(method));
    return names;
  }();
  return list;
}

std::string default_name(Item item, std::size_t index) { return fmt::format("{}{}", item_key(item), index + 1); }

std::vector<std::string> SceneFile::*names(Item item) {
  static constexpr std::vector<std::string> SceneFile::*lists[] = {nullptr,
                                                                   &SceneFile::body_names,
                                                                   &SceneFile::guide_names,
                                                                   &SceneFile::drive_names,
                                                                   &SceneFile::pin_names,
                                                                   &SceneFile::spring_names,
                                                                   &SceneFile::joint_spring_names,
                                                                   &SceneFile::load_names};
  return lists[static_cast<int>(item)];
}

std::string SceneFile::title(Item item, int index) const {
  if (item == Item::scene) return "scene";
  return fmt::format("{} {}", item_key(item), quote((this->*names(item))[static_cast<std::size_t>(index)]));
}

int SceneFile::line(Item item, int index) const {
  const auto& list = lines[static_cast<std::size_t>(item)];
  return index >= 0 && index < static_cast<int>(list.size()) ? list[static_cast<std::size_t>(index)] : 0;
}

std::string to_string(const FileDefect& defect) {
  return defect.line > 0 ? fmt::format("{}:{}: {}", defect.file, defect.line, defect.message)
                         : fmt::format("{}: {}", defect.file, defect.message);
}

void start_on_laws(Scene<RunSize>& scene) {
  for (int d = 0; d < scene.drives; ++d) {
    const Drive& drive = scene.drive[d];
    const double(&c)[8] = drive.c;
    double& q = scene.body[drive.body].q[drive.axis];
    double& v = scene.body[drive.body].v[drive.axis];
    if (drive.law == Law::harmonic) {
      q = c[0] + c[1] * std::sin(c[3]);
      v = c[1] * c[2] * std::cos(c[3]);
    } else if (drive.law != Law::input) {
      q = c[0];
      v = c[1];
    }
  }
}

Reading parse_scene(std::string_view text, const std::string& file, const std::vector<std::string>& settings) {
  if (auto refused = refuse(text, file)) return {std::nullopt, {*std::move(refused)}};
  Reading reading;
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const int line = static_cast<int>(error.source().begin.line);
    reading.defects.push_back({file, line, "is not TOML: " + printable(error.description(), most_of_error)});
    return reading;
  }
  for (const std::string& setting : settings) apply_setting(root, setting, reading.defects);

  Problems problems(file);
  SceneFile scene_file;
  scene_file.file = file;
  scene_file.hash = fnv1a(text);
  scene_file.settings = settings;
  Build build{root, problems, scene_file, {}, {}};
  read_scene_fields(build);
  read_items(build);
  read_baumgarte(build);
  read_run(build);
  add_findings(build);
  std::ranges::move(std::move(problems).sorted(), std::back_inserter(reading.defects));
  if (reading.defects.empty()) {
    start_on_laws(scene_file.scene);
    reading.scene = std::move(scene_file);
  }
  return reading;
}

Reading read_scene(const std::string& file, const std::vector<std::string>& settings) {
  const FileText text = read_text(file, largest_text);
  if (!text.problem.empty()) return {std::nullopt, {{file, 0, text.problem}}};
  return parse_scene(text.text, file, settings);
}

}  // namespace slideway::io
