#include <array>
#include <cmath>
#include <slideway/properties/mechanism.hpp>
#include <vector>

namespace slideway::properties {
namespace {

struct Pose {
  Vec2 origin{0, 0};
  double cosine = 1, sine = 0;

  Vec2 direction(Vec2 r) const { return {cosine * r.x - sine * r.y, sine * r.x + cosine * r.y}; }
  Vec2 into(Vec2 r) const { return {cosine * r.x + sine * r.y, cosine * r.y - sine * r.x}; }
  Vec2 place(Vec2 r) const {
    const Vec2 d = direction(r);
    return {origin.x + d.x, origin.y + d.y};
  }
  Vec2 local(Vec2 place) const { return into({place.x - origin.x, place.y - origin.y}); }
};

Pose turned(const Pose& p, Vec2 turn) {
  return {p.origin, p.cosine * turn.x - p.sine * turn.y, p.sine * turn.x + p.cosine * turn.y};
}

/// scene.hpp's frames at the start.
std::vector<Pose> poses_of(const MechanismScene& scene) {
  std::vector<Pose> poses;
  for (int i = 0; i < scene.bodies; ++i) {
    const Body& body = scene.body[i];
    const Pose parent = body.parent == ground ? Pose{} : poses[static_cast<std::size_t>(body.parent)];
    Pose pose = turned(parent, body.turn);
    pose.origin = parent.place(body.at);
    const bool slides = body.joint == Joint::prismatic || body.joint == Joint::planar;
    if (slides) pose.origin = pose.place({body.q[0], body.joint == Joint::planar ? body.q[1] : 0});
    const double angle = body.joint == Joint::revolute ? body.q[0] : body.joint == Joint::planar ? body.q[2] : 0;
    poses.push_back(turned(pose, {std::cos(angle), std::sin(angle)}));
  }
  return poses;
}

Vec2 dyadic_pair(Choices& choices, int places) {
  const double x = choices.dyadic(places);
  return {x, choices.dyadic(places)};
}

Body draw_body(Choices& choices, int i) {
  Body body;
  body.joint = std::array{Joint::prismatic, Joint::revolute, Joint::planar,
                          Joint::fixed}[static_cast<std::size_t>(choices.below(i == 0 ? 3 : 4))];
  body.parent = choices.below(i + 1) - 1;
  if (i > 0 && choices.flag()) body.parent = i - 1;
  body.at = dyadic_pair(choices, 5);
  if (choices.flag()) {
    body.angle = choices.dyadic(5);
    if (body.angle != 0) body.turn = {std::cos(body.angle), std::sin(body.angle)};
  }
  body.mass = choices.positive(5);
  body.inertia = choices.positive(7);
  if (choices.flag()) body.com = dyadic_pair(choices, 7);
  for (int k = 0; k < coordinates(body.joint); ++k) {
    body.q[k] = choices.dyadic(5);
    body.v[k] = choices.dyadic(5);
  }
  return body;
}

Drive draw_drive(Choices& choices, const MechanismScene& scene, int body) {
  Drive drive;
  drive.body = body;
  drive.axis = choices.below(coordinates(scene.body[body].joint));
  switch (choices.below(3)) {
    case 0:
      drive.law = Law::uniform;
      drive.c[0] = choices.dyadic(5);
      drive.c[1] = choices.dyadic(5);
      break;
    case 1:
      drive.law = Law::harmonic;
      drive.c[0] = choices.dyadic(5);
      drive.c[1] = choices.dyadic(5);
      drive.c[2] = choices.positive(5);
      drive.c[3] = choices.dyadic(5);
      drive.terms = 4;
      break;
    default:
      drive.law = Law::polynomial;
      drive.terms = 1 + choices.below(5);
      for (int k = 0; k < drive.terms; ++k) drive.c[k] = choices.dyadic(5);
  }
  return drive;
}

/// The coordinate is put on its law at t = 0.
void start_on_law(const Drive& drive, Body& body) {
  const bool harmonic = drive.law == Law::harmonic;
  body.q[drive.axis] = harmonic ? drive.c[0] + drive.c[1] * std::sin(drive.c[3]) : drive.c[0];
  body.v[drive.axis] = harmonic ? drive.c[1] * drive.c[2] * std::cos(drive.c[3]) : drive.terms > 1 ? drive.c[1] : 0;
}

/// A guide that fits the start: its line goes through the contacts.
Guide draw_guide(Choices& choices, const MechanismScene& scene, const std::vector<Pose>& poses, bool room_for_two) {
  Guide guide;
  guide.slider = choices.below(scene.bodies);
  guide.rail = choices.below(scene.bodies) - 1;
  if (guide.rail >= guide.slider) ++guide.rail;
  if (guide.rail >= scene.bodies) guide.rail = ground;
  guide.contact[0] = dyadic_pair(choices, 6);
  guide.direction = {choices.positive(4), choices.dyadic(4)};
  if (choices.flag()) guide.direction = {guide.direction.y, -guide.direction.x};
  const double length = std::hypot(guide.direction.x, guide.direction.y);
  guide.tangent = {guide.direction.x / length, guide.direction.y / length};
  const Pose slider = poses[static_cast<std::size_t>(guide.slider)];
  const Pose rail = guide.rail == ground ? Pose{} : poses[static_cast<std::size_t>(guide.rail)];
  guide.origin = rail.local(slider.place(guide.contact[0]));
  const double along = choices.dyadic(5);
  guide.origin = {guide.origin.x + along * guide.tangent.x, guide.origin.y + along * guide.tangent.y};
  if (room_for_two && choices.flag()) {
    guide.contacts = 2;
    const double apart = choices.positive(7);
    const Vec2 d = slider.into(rail.direction(guide.tangent));
    guide.contact[1] = {guide.contact[0].x + apart * d.x, guide.contact[0].y + apart * d.y};
  }
  guide.mu = std::ldexp(choices.below(64), -7);  // below 1/2
  guide.mu_static = guide.mu + (choices.flag() ? std::ldexp(choices.below(64), -8) : 0);
  if (choices.below(4) == 1) guide.viscous = choices.positive(6);
  if (choices.below(4) == 1) guide.preload = choices.positive(6);
  return guide;
}

Pin draw_pin(Choices& choices, const MechanismScene& scene, const std::vector<Pose>& poses) {
  Pin pin;
  pin.a = choices.below(scene.bodies);
  pin.b = choices.below(scene.bodies) - 1;
  if (pin.b >= pin.a) ++pin.b;
  if (pin.b >= scene.bodies) pin.b = ground;
  pin.a_at = dyadic_pair(choices, 6);
  const Vec2 place = poses[static_cast<std::size_t>(pin.a)].place(pin.a_at);
  pin.b_at = pin.b == ground ? place : poses[static_cast<std::size_t>(pin.b)].local(place);
  return pin;
}

void draw_forces(Choices& choices, MechanismScene& scene) {
  if (choices.flag()) {
    const int a = choices.below(scene.bodies);
    scene.spring[scene.springs++] = {
        a,
        ground,
        dyadic_pair(choices, 6),
        {4 + choices.dyadic(5), choices.dyadic(5)},  // a spring of no length has no direction
        choices.positive(2),
        choices.positive(6),
        choices.flag() ? choices.positive(6) : 0};
  }
  for (int i = 0; i < scene.bodies && choices.flag(); ++i) {
    if (coordinates(scene.body[i].joint) != 1) continue;
    scene.joint_spring[scene.joint_springs++] = {i, choices.positive(3), choices.dyadic(5),
                                                 choices.flag() ? choices.positive(6) : 0};
  }
  for (int k = choices.below(3); k > 0; --k) {
    Load& load = scene.load[scene.loads++];
    load.body = choices.below(scene.bodies);
    if (choices.flag()) load.at = dyadic_pair(choices, 6);
    load.force = dyadic_pair(choices, 2);
    if (choices.flag()) load.torque = choices.dyadic(4);
  }
}

/// Onto the constraints, positions and rates, by the kernel's projection.
bool assemble(MechanismScene& scene) {
  const io::RunStepper stepper(scene);
  auto state = stepper.start();
  if (stepper.project(state).status != Status::ok) return false;
  double fastest = 1;
  for (int j = 0; j < stepper.source.tables.coordinates; ++j) fastest = std::fmax(fastest, std::fabs(state.v[j]));
  for (int i = 0, j = 0; i < scene.bodies; ++i) {
    for (int k = 0; k < coordinates(scene.body[i].joint); ++k, ++j) {
      scene.body[i].q[k] = state.q[j];
      // A speed that is all rounding is none.
      scene.body[i].v[k] = std::fabs(state.v[j]) > 0x1p-44 * fastest ? state.v[j] : 0;
    }
  }
  return true;
}

void scale_speeds(MechanismScene& scene, double by) {
  for (int i = 0; i < scene.bodies; ++i) {
    for (double& v : scene.body[i].v) v *= by;
  }
}

/// A block on the ground, pushed by what mu_static allows, times `part`.
MechanismScene at_friction_limit(Choices& choices, double part) {
  MechanismScene scene;
  scene.bodies = scene.guides = scene.loads = 1;
  scene.body[0].joint = Joint::planar;
  scene.body[0].mass = choices.positive(5);
  scene.body[0].inertia = choices.positive(7);
  scene.gravity = {0, -8};
  Guide& guide = scene.guide[0];
  guide.contacts = 2;
  guide.contact[0] = {-choices.positive(6), 0};
  guide.contact[1] = {choices.positive(6), 0};
  guide.mu = std::ldexp(1 + choices.below(63), -7);
  guide.mu_static = guide.mu + (choices.flag() ? std::ldexp(choices.below(64), -8) : 0);
  scene.load[0].force = {part * guide.mu_static * 8 * scene.body[0].mass * (choices.flag() ? 1 : -1), 0};
  return scene;
}

/// All sliding speeds, or all forces, made zero.
void move_to_kink(Choices& choices, MechanismScene& scene, double beside) {
  if (scene.drives == 0) scale_speeds(scene, beside);
  if (!choices.flag()) return;
  scene.gravity = {scene.gravity.x * beside, scene.gravity.y * beside};
  for (int l = 0; l < scene.loads; ++l) {
    scene.load[l].force = {scene.load[l].force.x * beside, scene.load[l].force.y * beside};
    scene.load[l].torque *= beside;
  }
  scene.springs = scene.joint_springs = 0;
}

}  // namespace

const char* name(Stratum stratum) {
  return stratum == Stratum::generic ? "generic" : stratum == Stratum::on_kink ? "on a kink" : "beside a kink";
}

Mechanism draw_mechanism(Choices& choices) {
  Mechanism mechanism;
  MechanismScene& scene = mechanism.scene;
  mechanism.stratum = std::array{Stratum::generic, Stratum::generic, Stratum::on_kink,
                                 Stratum::beside}[static_cast<std::size_t>(choices.below(4))];
  const bool on_kink = mechanism.stratum == Stratum::on_kink;
  if (mechanism.stratum != Stratum::generic && choices.below(4) == 1) {
    scene = at_friction_limit(choices, on_kink ? 1 : choices.flag() ? 1 + 0x1p-27 : 1 - 0x1p-27);
    mechanism.assembled = assemble(scene);
    return mechanism;
  }
  scene.bodies = 1 + choices.below(5);
  int left = 0;  // free coordinates that no constraint has taken
  for (int i = 0; i < scene.bodies; ++i) {
    scene.body[i] = draw_body(choices, i);
    left += coordinates(scene.body[i].joint);
  }
  if (choices.flag()) scene.gravity = {0, -9.8125};
  for (int i = 0; i < scene.bodies && scene.drives < 2; ++i) {
    if (coordinates(scene.body[i].joint) == 0 || choices.below(4) != 1) continue;
    scene.drive[scene.drives] = draw_drive(choices, scene, i);
    start_on_law(scene.drive[scene.drives++], scene.body[i]);
    --left;
  }
  const std::vector<Pose> poses = poses_of(scene);
  for (int k = choices.below(7); k > 0 && left > 0; --k) {
    scene.guide[scene.guides] = draw_guide(choices, scene, poses, left > 1);
    left -= scene.guide[scene.guides++].contacts;
  }
  if (left > 2 && choices.below(4) == 1) {
    scene.pin[scene.pins++] = draw_pin(choices, scene, poses);
    left -= 2;
  }
  draw_forces(choices, scene);
  if (mechanism.stratum != Stratum::generic) move_to_kink(choices, scene, on_kink ? 0 : 0x1p-27);
  mechanism.assembled = assemble(scene);
  return mechanism;
}

}  // namespace slideway::properties
