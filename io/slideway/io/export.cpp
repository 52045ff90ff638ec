#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <slideway/io/build.hpp>
#include <slideway/io/export.hpp>
#include <slideway/io/text.hpp>

namespace slideway::io {
namespace {

using Lines = std::back_insert_iterator<std::string>;

/// Hexadecimal: the same bits in every compiler. Small integers as such: they are exact, and a person can read them.
std::string literal(double x) {
  if (x == static_cast<double>(static_cast<int>(std::clamp(x, -1e6, 1e6))) && !(x == 0 && std::signbit(x))) {
    return fmt::format("{:.0f}", x);
  }
  return fmt::format("{:a}", x);
}

std::string literal(Vec2 r) { return fmt::format("{{{}, {}}}", literal(r.x), literal(r.y)); }
std::string literal(int n) { return n == ground ? "slideway::ground" : fmt::format("{}", n); }
std::string literal(Joint joint) {
  static constexpr const char* names[] = {"revolute", "prismatic", "planar", "fixed"};
  return fmt::format("slideway::Joint::{}", names[static_cast<int>(joint)]);
}
std::string literal(Law law) {
  static constexpr const char* names[] = {"uniform", "harmonic", "polynomial", "input"};
  return fmt::format("slideway::Law::{}", names[static_cast<int>(law)]);
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same(Vec2 a, Vec2 b) { return same(a.x, b.x) && same(a.y, b.y); }
template <class T>
bool same(T a, T b) {
  return a == b;
}

/// One item of an array: assignments of what is not the default, in the order of its declaration.
class ItemWriter {
 public:
  ItemWriter(std::string& out, const char* array, int index) : out_(out), place_(fmt::format("{}[{}]", array, index)) {}

  template <class T>
  void operator()(const char* field, const T& value, const T& standard) {
    if (!same(value, standard)) always(field, value);
  }
  template <class T>
  void always(const char* field, const T& value) {
    const std::string shown = literal(value);
    fmt::format_to(Lines(out_), "  scene.{}.{} = {};{}\n", place_, field, shown, remark(value, shown));
  }
  template <class T, std::size_t N>
  void each(const char* field, const T (&values)[N], int count) {
    for (int i = 0; i < count; ++i) (*this)(fmt::format("{}[{}]", field, i).c_str(), values[i], T{});
  }

 private:
  /// The decimal beside a hexadecimal number.
  static std::string remark(double value, const std::string& shown) {
    return shown.find('x') == shown.npos ? "" : fmt::format("  // {}", value);
  }
  static std::string remark(Vec2 value, const std::string& shown) {
    return shown.find('x') == shown.npos ? "" : fmt::format("  // {}, {}", value.x, value.y);
  }
  template <class T>
  static std::string remark(const T&, const std::string&) {
    return {};
  }

  std::string& out_;
  std::string place_;
};

void write(ItemWriter out, const Body& body) {
  const Body standard;
  out.always("parent", body.parent);
  out.always("joint", body.joint);
  out("at", body.at, standard.at);
  out("angle", body.angle, standard.angle);
  out("turn", body.turn, standard.turn);
  out("mass", body.mass, standard.mass);
  out("com", body.com, standard.com);
  out("inertia", body.inertia, standard.inertia);
  out.each("q", body.q, coordinates(body.joint));
  out.each("v", body.v, coordinates(body.joint));
}

void write(ItemWriter out, const Guide& guide) {
  const Guide standard;
  out.always("slider", guide.slider);
  out.always("rail", guide.rail);
  out("origin", guide.origin, standard.origin);
  out("direction", guide.direction, standard.direction);
  out("tangent", guide.tangent, standard.tangent);
  out("contacts", guide.contacts, standard.contacts);
  out.each("contact", guide.contact, guide.contacts);
  out("mu", guide.mu, standard.mu);
  out("mu_static", guide.mu_static, standard.mu_static);
  out("viscous", guide.viscous, standard.viscous);
  out("preload", guide.preload, standard.preload);
}

void write(ItemWriter out, const Drive& drive) {
  const Drive standard;
  out.always("body", drive.body);
  out("axis", drive.axis, standard.axis);
  out.always("law", drive.law);
  out("terms", drive.terms, standard.terms);
  out.each("c", drive.c, 8);
  out("input", drive.input, standard.input);
}

void write(ItemWriter out, const Pin& pin) {
  out.always("a", pin.a);
  out.always("b", pin.b);
  out("a_at", pin.a_at, Vec2{});
  out("b_at", pin.b_at, Vec2{});
}

void write(ItemWriter out, const Spring& spring) {
  out.always("a", spring.a);
  out.always("b", spring.b);
  out("a_at", spring.a_at, Vec2{});
  out("b_at", spring.b_at, Vec2{});
  out("stiffness", spring.stiffness, 0.0);
  out("length", spring.length, 0.0);
  out("damping", spring.damping, 0.0);
}

void write(ItemWriter out, const JointSpring& spring) {
  out.always("body", spring.body);
  out("stiffness", spring.stiffness, 0.0);
  out("rest", spring.rest, 0.0);
  out("damping", spring.damping, 0.0);
}

void write(ItemWriter out, const Load& load) {
  out.always("body", load.body);
  out("at", load.at, Vec2{});
  out("force", load.force, Vec2{});
  out("torque", load.torque, 0.0);
  out("input", load.input, none);
}

template <class T>
void write_items(std::string& out, const SceneFile& file, Item item, const T* items, int count) {
  for (int i = 0; i < count; ++i) {
    fmt::format_to(Lines(out), "\n  // {}\n", file.title(item, i));
    write(ItemWriter(out, item_keys[static_cast<int>(item)].data(), i), items[i]);
  }
}

void write_counts(std::string& out, const Scene<RunSize>& scene) {
  const auto count = [&](const char* field, int n) {
    if (n > 0) fmt::format_to(Lines(out), "  scene.{} = {};\n", field, n);
  };
  count("bodies", scene.bodies);
  count("guides", scene.guides);
  count("drives", scene.drives);
  count("pins", scene.pins);
  count("springs", scene.springs);
  count("joint_springs", scene.joint_springs);
  count("loads", scene.loads);
  count("inputs", scene.inputs);
}

std::string size_of(const Scene<RunSize>& scene) {
  return fmt::format("slideway::Size<{}, {}, {}, {}, {}, {}, {}, {}, {}, {}>", scene.bodies, coordinates(scene),
                     scene.guides, contacts(scene), scene.drives, scene.pins, scene.springs, scene.joint_springs,
                     scene.loads, scene.inputs);
}

void write_indices(std::string& out, const SceneFile& file) {
  const auto each = [&](std::string_view kind, const std::vector<std::string>& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      fmt::format_to(Lines(out), "inline constexpr int {}_{} = {};\n", kind, list[i], i);
    }
  };
  for (int item = 1; item < 8; ++item) each(item_keys[item], file.*names(static_cast<Item>(item)));
  each("input", file.input_names);
  int coordinate = 0, contact = 0;
  for (int i = 0; i < file.scene.bodies; ++i) {  // a body's first place in State::q and State::v
    const int n = coordinates(file.scene.body[i].joint);
    if (n > 0) {
      fmt::format_to(Lines(out), "inline constexpr int coordinate_{} = {};\n",
                     file.body_names[static_cast<std::size_t>(i)], coordinate);
    }
    coordinate += n;
  }
  for (int g = 0; g < file.scene.guides; ++g) {  // a guide's first place in Reaction::lambda
    fmt::format_to(Lines(out), "inline constexpr int contact_{} = {};\n", file.guide_names[static_cast<std::size_t>(g)],
                   contact);
    contact += file.scene.guide[g].contacts;
  }
}

}  // namespace

std::string export_problem(const SceneFile& file) {
  static constexpr std::string_view taken[] = {"alignas",     "alignof",      "and",          "and_eq",
                                               "asm",         "auto",         "bitand",       "bitor",
                                               "bool",        "break",        "case",         "catch",
                                               "char",        "char16_t",     "char32_t",     "char8_t",
                                               "class",       "co_await",     "co_return",    "co_yield",
                                               "compl",       "concept",      "const",        "const_cast",
                                               "consteval",   "constexpr",    "constinit",    "continue",
                                               "decltype",    "default",      "delete",       "do",
                                               "double",      "dynamic_cast", "else",         "enum",
                                               "explicit",    "export",       "extern",       "false",
                                               "float",       "for",          "friend",       "goto",
                                               "if",          "inline",       "int",          "long",
                                               "main",        "mutable",      "namespace",    "new",
                                               "noexcept",    "not",          "not_eq",       "nullptr",
                                               "operator",    "or",           "or_eq",        "private",
                                               "protected",   "public",       "register",     "reinterpret_cast",
                                               "requires",    "return",       "short",        "signed",
                                               "sizeof",      "slideway",     "static",       "static_assert",
                                               "static_cast", "std",          "struct",       "switch",
                                               "template",    "this",         "thread_local", "throw",
                                               "true",        "try",          "typedef",      "typeid",
                                               "typename",    "union",        "unsigned",     "using",
                                               "virtual",     "void",         "volatile",     "wchar_t",
                                               "while",       "xor",          "xor_eq"};
  const bool reserved = file.name.starts_with('_') || file.name.find("__") != std::string::npos;
  if (!reserved && std::ranges::find(taken, file.name) == std::end(taken)) return {};
  return fmt::format("scene is called {}, which C++ keeps for itself: give it another name", quote(file.name));
}

std::string export_header(const SceneFile& file) {
  const Scene<RunSize>& scene = file.scene;
  std::string out;
  fmt::format_to(Lines(out), "// Written by `slideway export` from {}, hash {}; do not edit.\n",
                 file.file.substr(file.file.rfind('/') + 1), file.hash);
  for (const std::string& setting : file.settings) fmt::format_to(Lines(out), "// --set {}\n", setting);
  out += "#pragma once\n\n#include <slideway/scene.hpp>\n\n";
  fmt::format_to(Lines(out), "inline constexpr slideway::Scene<{0}> {1} = [] {{\n  slideway::Scene<{0}> scene{{}};\n",
                 size_of(scene), file.name);
  const Scene<RunSize> standard;
  const auto value = [&](const char* field, auto x, auto usual) {
    if (!same(x, usual)) fmt::format_to(Lines(out), "  scene.{} = {};\n", field, literal(x));
  };
  value("gravity", scene.gravity, standard.gravity);
  value("alpha", scene.alpha, standard.alpha);
  value("beta", scene.beta, standard.beta);
  write_counts(out, scene);
  write_items(out, file, Item::body, scene.body, scene.bodies);
  write_items(out, file, Item::guide, scene.guide, scene.guides);
  write_items(out, file, Item::drive, scene.drive, scene.drives);
  write_items(out, file, Item::pin, scene.pin, scene.pins);
  write_items(out, file, Item::spring, scene.spring, scene.springs);
  write_items(out, file, Item::joint_spring, scene.joint_spring, scene.joint_springs);
  write_items(out, file, Item::load, scene.load, scene.loads);
  fmt::format_to(Lines(out), "  return scene;\n}}();\n\nstatic_assert(slideway::defects({}).count == 0);\n\n",
                 file.name);
  fmt::format_to(Lines(out), "namespace {}_index {{\n", file.name);
  write_indices(out, file);
  fmt::format_to(Lines(out), "}}  // namespace {}_index\n", file.name);
  return out;
}

}  // namespace slideway::io
