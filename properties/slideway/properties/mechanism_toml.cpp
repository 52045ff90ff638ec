#include <fmt/format.h>

#include <slideway/properties/mechanism.hpp>

namespace slideway::properties {
namespace {

std::string pair(Vec2 r) { return fmt::format("[{:.17g}, {:.17g}]", r.x, r.y); }

std::string list(const double* x, int n) {
  std::string text;
  for (int k = 0; k < n; ++k) text += fmt::format("{}{:.17g}", k > 0 ? ", " : "", x[k]);
  return "[" + text + "]";
}

std::string body_name(int i) { return i == ground ? "ground" : fmt::format("body{}", i); }

const char* name(Joint joint) {
  return joint == Joint::revolute    ? "revolute"
         : joint == Joint::prismatic ? "prismatic"
         : joint == Joint::planar    ? "planar"
                                     : "fixed";
}

std::string toml_of(const Body& body, int i) {
  const int n = coordinates(body.joint);
  std::string text = fmt::format(
      "\n[[body]]\nname = \"{}\"\nparent = \"{}\"\njoint = \"{}\"\nat = {}\nangle = {:.17g}\nmass = {:.17g}\n"
      "com = {}\ninertia = {:.17g}\n",
      body_name(i), body_name(body.parent), name(body.joint), pair(body.at), body.angle, body.mass, pair(body.com),
      body.inertia);
  if (n > 0) text += fmt::format("q = {}\nv = {}\n", list(body.q, n), list(body.v, n));
  return text;
}

std::string toml_of(const Guide& guide, int g) {
  std::string contacts = pair(guide.contact[0]);
  if (guide.contacts == 2) contacts += ", " + pair(guide.contact[1]);
  return fmt::format(
      "\n[[guide]]\nname = \"guide{}\"\nslider = \"{}\"\nrail = \"{}\"\norigin = {}\ndirection = {}\ncontacts = [{}]\n"
      "mu = {:.17g}\nmu_static = {:.17g}\nviscous = {:.17g}\npreload = {:.17g}\n",
      g, body_name(guide.slider), body_name(guide.rail), pair(guide.origin), pair(guide.direction), contacts, guide.mu,
      guide.mu_static, guide.viscous, guide.preload);
}

std::string toml_of(const Drive& drive, int d, Joint joint) {
  std::string text = fmt::format("\n[[drive]]\nname = \"drive{}\"\nbody = \"{}\"\n", d, body_name(drive.body));
  if (joint == Joint::planar) {
    text += fmt::format("coordinate = \"{}\"\n", drive.axis == 0 ? "x" : drive.axis == 1 ? "y" : "angle");
  }
  const double(&c)[8] = drive.c;
  if (drive.law == Law::uniform)
    return text + fmt::format("law = \"uniform\"\nstart = {:.17g}\nrate = {:.17g}\n", c[0], c[1]);
  if (drive.law == Law::harmonic) {
    return text + fmt::format(
                      "law = \"harmonic\"\noffset = {:.17g}\namplitude = {:.17g}\nfrequency = {:.17g}\n"
                      "phase = {:.17g}\n",
                      c[0], c[1], c[2], c[3]);
  }
  return text + fmt::format("law = \"polynomial\"\ncoefficients = {}\n", list(c, drive.terms));
}

}  // namespace

std::string toml(const MechanismScene& scene) {
  std::string text = fmt::format("name = \"drawn\"\ngravity = {}\n", pair(scene.gravity));
  for (int i = 0; i < scene.bodies; ++i) text += toml_of(scene.body[i], i);
  for (int g = 0; g < scene.guides; ++g) text += toml_of(scene.guide[g], g);
  for (int d = 0; d < scene.drives; ++d) text += toml_of(scene.drive[d], d, scene.body[scene.drive[d].body].joint);
  for (int p = 0; p < scene.pins; ++p) {
    const Pin& pin = scene.pin[p];
    text += fmt::format("\n[[pin]]\nname = \"pin{}\"\na = \"{}\"\nb = \"{}\"\na_at = {}\nb_at = {}\n", p,
                        body_name(pin.a), body_name(pin.b), pair(pin.a_at), pair(pin.b_at));
  }
  for (int s = 0; s < scene.springs; ++s) {
    const Spring& spring = scene.spring[s];
    text += fmt::format(
        "\n[[spring]]\na = \"{}\"\nb = \"{}\"\na_at = {}\nb_at = {}\nstiffness = {:.17g}\nlength = {:.17g}\n"
        "damping = {:.17g}\n",
        body_name(spring.a), body_name(spring.b), pair(spring.a_at), pair(spring.b_at), spring.stiffness, spring.length,
        spring.damping);
  }
  for (int s = 0; s < scene.joint_springs; ++s) {
    const JointSpring& spring = scene.joint_spring[s];
    text += fmt::format("\n[[joint_spring]]\nbody = \"{}\"\nstiffness = {:.17g}\nrest = {:.17g}\ndamping = {:.17g}\n",
                        body_name(spring.body), spring.stiffness, spring.rest, spring.damping);
  }
  for (int l = 0; l < scene.loads; ++l) {
    const Load& load = scene.load[l];
    text += fmt::format("\n[[load]]\nbody = \"{}\"\nat = {}\nforce = {}\ntorque = {:.17g}\n", body_name(load.body),
                        pair(load.at), pair(load.force), load.torque);
  }
  return text + fmt::format("\n[baumgarte]\nalpha = {:.17g}\nbeta = {:.17g}\n", scene.alpha, scene.beta);
}

}  // namespace slideway::properties
