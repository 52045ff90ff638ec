// One table of a kind -> one item of the scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <slideway/io/build.hpp>
#include <slideway/io/text.hpp>

namespace slideway::io {
namespace {

constexpr int unknown = -2;  ///< neither a body nor the ground

std::vector<std::string> body_names(const Build& build) {
  std::vector<std::string> list;
  for (const auto& [name, index] : build.bodies) list.push_back(name);
  list.emplace_back("ground");
  return list;
}

enum class Ground { allowed, refused };

/// The index of the body that `key` names. One that does not exist is a defect here, so that its name can be told.
int body_index(Build& build, Fields& fields, std::string_view key, Item item, int index, Ground ground_is,
               const char* fallback = nullptr) {
  const bool absent = fallback != nullptr && !fields.has(key);
  if (absent) fields.know(key);
  const std::optional<std::string> given = absent ? fallback : fields.required_text(key);
  const std::string name = given.value_or("");
  if (name == "ground" && ground_is == Ground::allowed) return ground;
  if (const auto found = build.bodies.find(name); found != build.bodies.end()) {
    if (found->second < RunSize::bodies) return found->second;
  } else if (name == "ground") {
    fields.defect(key, fmt::format("needs a body as {}, not \"ground\"", key));
  } else if (given) {
    fields.defect(
        key, fmt::format("has {} = {}, which is not a body{}", key, quote(name), suggestion(name, body_names(build))));
  }
  build.unresolved.insert({item, index});
  return unknown;
}

int input_index(Build& build, Fields& fields, Item item, int index) {
  const auto given = fields.required_text("input");
  const std::string name = given.value_or("");
  std::vector<std::string>& inputs = build.file.input_names;
  const auto found = std::find(inputs.begin(), inputs.end(), name);
  const int position = static_cast<int>(found - inputs.begin());
  if (found != inputs.end()) return position;
  if (is_name(name) && position < RunSize::inputs) {
    inputs.push_back(name);
    return position;
  }
  if (is_name(name)) {
    fields.defect("input", fmt::format("needs one of the first {} inputs: there is no room for more", position));
  } else if (given) {
    fields.defect("input", fmt::format("needs an input made of letters, digits and _, not {}", quote(name)));
  }
  build.unresolved.insert({item, index});
  return none;
}

/// Start values: as many as the joint has coordinates.
void read_start(Fields& fields, std::string_view key, Joint joint, double (&start)[3]) {
  const auto values = fields.numbers(key);
  if (!values) return;
  const int count = coordinates(joint);
  if (static_cast<int>(values->size()) == count) {
    std::copy(values->begin(), values->end(), start);
  } else if (count == 0) {
    fields.defect(key, fmt::format("is fixed: leave {} out", key));
  } else {
    fields.defect(key, fmt::format("needs {} = {} for its joint, not {} numbers", key,
                                   count == 3 ? "[x, y, angle]" : "[number]", values->size()));
  }
}

/// (cos angle, sin angle), exact where the angle is zero; (1, 0) where it is not a number: that is another defect.
Vec2 turn(double angle) {
  return angle == 0 || !std::isfinite(angle) ? Vec2{1, 0} : Vec2{std::cos(angle), std::sin(angle)};
}

/// direction / |direction|. Scaled by a power of two first, so that no length over- or underflows; along an axis the
/// division is of a number by itself.
Vec2 tangent(Vec2 direction) {
  const double largest = std::fmax(std::fabs(direction.x), std::fabs(direction.y));
  if (!(std::isfinite(direction.x) && std::isfinite(direction.y)) || largest == 0) return {1, 0};
  const int exponent = std::ilogb(largest);
  const double x = std::scalbn(direction.x, -exponent), y = std::scalbn(direction.y, -exponent);
  const double length = std::hypot(x, y);
  return {x / length, y / length};
}

void read_law(Build& build, Fields& fields, int d, Drive& drive) {
  switch (drive.law) {
    case Law::uniform:
      drive.c[0] = fields.number("start").value_or(0);
      drive.c[1] = fields.required_number("rate");
      break;
    case Law::harmonic:
      drive.terms = 4;
      drive.c[0] = fields.number("offset").value_or(0);
      drive.c[1] = fields.required_number("amplitude");
      drive.c[2] = fields.required_number("frequency");
      drive.c[3] = fields.number("phase").value_or(0);
      break;
    case Law::polynomial: {
      if (!fields.require("coefficients", "[c0, c1, ...]")) break;
      const auto values = fields.numbers("coefficients").value_or(std::vector<double>{0});
      drive.terms = static_cast<int>(std::min<std::size_t>(values.size(), 9));
      std::copy_n(values.begin(), std::min(drive.terms, 8), drive.c);
      break;
    }
    case Law::input:
      drive.input = input_index(build, fields, Item::drive, d);
      break;
  }
}

}  // namespace

Body read_body(Build& build, Fields& fields, int i) {
  static const std::vector<std::string> joints{"revolute", "prismatic", "planar", "fixed"};
  Body body;
  body.parent = body_index(build, fields, "parent", Item::body, i, Ground::allowed);
  const auto joint = fields.choice("joint", joints);
  body.joint = static_cast<Joint>(joint.value_or(0));
  body.at = fields.vec2("at").value_or(Vec2{});
  body.angle = fields.number("angle").value_or(0);
  body.turn = turn(body.angle);
  body.mass = fields.required_number("mass");
  body.com = fields.vec2("com").value_or(Vec2{});
  body.inertia = fields.required_number("inertia");
  fields.know("q");
  fields.know("v");
  if (fields.has("joint") && !joint) {  // what q and v should be, nobody knows
    build.unresolved.insert({Item::body, i});
    return body;
  }
  read_start(fields, "q", body.joint, body.q);
  read_start(fields, "v", body.joint, body.v);
  return body;
}

Guide read_guide(Build& build, Fields& fields, int g) {
  Guide guide;
  guide.slider = body_index(build, fields, "slider", Item::guide, g, Ground::refused);
  guide.rail = body_index(build, fields, "rail", Item::guide, g, Ground::allowed);
  guide.origin = fields.vec2("origin").value_or(Vec2{});
  if (fields.require("direction", "[x, y]")) guide.direction = fields.vec2("direction").value_or(Vec2{1, 0});
  guide.tangent = tangent(guide.direction);
  if (fields.require("contacts", "[[x, y]]")) {
    const auto points = fields.points("contacts").value_or(std::vector<Vec2>{Vec2{}});
    guide.contacts = static_cast<int>(std::min<std::size_t>(points.size(), 3));
    std::copy_n(points.begin(), std::min(guide.contacts, 2), guide.contact);
  }
  guide.mu = fields.required_number("mu");
  guide.mu_static = fields.number("mu_static").value_or(guide.mu);
  guide.viscous = fields.number("viscous").value_or(0);
  guide.preload = fields.number("preload").value_or(0);
  return guide;
}

Drive read_drive(Build& build, Fields& fields, int d) {
  static const std::vector<std::string> laws{"uniform", "harmonic", "polynomial", "input"};
  static const std::vector<std::string> axes{"x", "y", "angle"};
  Drive drive;
  drive.body = body_index(build, fields, "body", Item::drive, d, Ground::refused);
  const bool known_joint = drive.body >= 0 && !build.unresolved.contains({Item::body, drive.body});
  const bool planar = known_joint && build.file.scene.body[drive.body].joint == Joint::planar;
  if (planar) {
    drive.axis = fields.required_choice("coordinate", axes);
  } else if (fields.choice("coordinate", axes) && known_joint) {
    fields.defect("coordinate", "drives a body that is not planar: leave coordinate out");
  }
  if (!known_joint || drive.axis < 0) build.unresolved.insert({Item::drive, d});
  const int law = fields.required_choice("law", laws);
  if (law >= 0) {
    drive.law = static_cast<Law>(law);
    read_law(build, fields, d, drive);
  } else {
    for (const char* key : {"start", "rate", "offset", "amplitude", "frequency", "phase", "coefficients", "input"}) {
      fields.know(key);  // which of them are right, the law decides
    }
  }
  return drive;
}

Pin read_pin(Build& build, Fields& fields, int p) {
  Pin pin;
  pin.a = body_index(build, fields, "a", Item::pin, p, Ground::refused);
  pin.b = body_index(build, fields, "b", Item::pin, p, Ground::allowed, "ground");
  pin.a_at = fields.vec2("a_at").value_or(Vec2{});
  pin.b_at = fields.vec2("b_at").value_or(Vec2{});
  return pin;
}

Spring read_spring(Build& build, Fields& fields, int s) {
  Spring spring;
  spring.a = body_index(build, fields, "a", Item::spring, s, Ground::refused);
  spring.b = body_index(build, fields, "b", Item::spring, s, Ground::allowed, "ground");
  spring.a_at = fields.vec2("a_at").value_or(Vec2{});
  spring.b_at = fields.vec2("b_at").value_or(Vec2{});
  spring.stiffness = fields.number("stiffness").value_or(0);
  spring.length = fields.number("length").value_or(0);
  spring.damping = fields.number("damping").value_or(0);
  return spring;
}

JointSpring read_joint_spring(Build& build, Fields& fields, int s) {
  JointSpring spring;
  spring.body = body_index(build, fields, "body", Item::joint_spring, s, Ground::refused);
  spring.stiffness = fields.number("stiffness").value_or(0);
  spring.rest = fields.number("rest").value_or(0);
  spring.damping = fields.number("damping").value_or(0);
  return spring;
}

Load read_load(Build& build, Fields& fields, int l) {
  Load load;
  load.body = body_index(build, fields, "body", Item::load, l, Ground::refused);
  load.at = fields.vec2("at").value_or(Vec2{});
  load.force = fields.vec2("force").value_or(Vec2{});
  load.torque = fields.number("torque").value_or(0);
  if (fields.has("input")) load.input = input_index(build, fields, Item::load, l);
  fields.know("input");
  return load;
}

}  // namespace slideway::io
