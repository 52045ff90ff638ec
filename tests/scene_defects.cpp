// Every field of a scene, one at a time, set to what it may not be: that defect, of that item.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <slideway/structure.hpp>
#include <string>
#include <vector>

namespace {

using namespace slideway;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();

/// Three bodies and one of each other item; room for one more of each, but for coordinates and contacts.
using Room = Size<4, 5, 2, 2, 2, 2, 2, 2, 2, 2>;

Scene<Room> sound_scene() {
  Scene<Room> scene;
  scene.bodies = 3;
  scene.guides = scene.drives = scene.pins = scene.springs = scene.joint_springs = scene.loads = scene.inputs = 1;
  for (int i = 0; i < 3; ++i) scene.body[i].mass = scene.body[i].inertia = 1;
  scene.body[1].joint = Joint::planar;
  scene.guide[0].slider = scene.spring[0].a = 1;
  scene.guide[0].contacts = 2;
  scene.drive[0].law = Law::input;
  scene.drive[0].input = scene.load[0].input = 0;
  scene.pin[0].a = 2;
  return scene;
}

void expect_told(const Scene<Room>& scene, Item item, Defect defect, const std::string& how) {
  const Findings found = defects(scene);
  bool is_told = false;
  for (int k = 0; k < found.count; ++k) {
    is_told =
        is_told || (found.finding[k].item == item && found.finding[k].index == 0 && found.finding[k].defect == defect);
  }
  EXPECT_TRUE(is_told) << how << ": " << sentence(defect);
  EXPECT_FALSE(RunTime<Room>(scene).sound) << how;
}

/// A field of an item, and the values that are each that defect.
template <class T>
struct Field {
  T* field;
  Item item;
  Defect defect;
  std::vector<T> bad;
};

template <class T>
void expect_every(Scene<Room>& scene, const std::vector<Field<T>>& fields) {
  ASSERT_EQ(defects(scene).count, 0);
  for (std::size_t k = 0; k < fields.size(); ++k) {
    for (const T bad : fields[k].bad) {
      const T good = *fields[k].field;
      *fields[k].field = bad;
      expect_told(scene, fields[k].item, fields[k].defect, std::to_string(k) + "th field, " + std::to_string(bad));
      *fields[k].field = good;
    }
  }
}

TEST(SceneDefects, NumbersAreFinite) {
  Scene<Room> s = sound_scene();
  std::vector<Field<double>> fields;
  const auto add = [&](Item item, std::vector<double*> numbers) {
    for (double* x : numbers) fields.push_back({x, item, Defect::not_finite, {not_a_number, infinity, -infinity}});
  };
  const auto place = [&](Item item, Vec2& r) { add(item, {&r.x, &r.y}); };
  place(Item::scene, s.gravity);
  add(Item::scene, {&s.alpha, &s.beta});
  Body& body = s.body[0];
  for (Vec2* r : {&body.at, &body.turn, &body.com}) place(Item::body, *r);
  add(Item::body,
      {&body.angle, &body.mass, &body.inertia, &body.q[0], &body.q[1], &body.q[2], &body.v[0], &body.v[1], &body.v[2]});
  Guide& guide = s.guide[0];
  for (Vec2* r : {&guide.origin, &guide.direction, &guide.tangent, &guide.contact[0], &guide.contact[1]}) {
    place(Item::guide, *r);
  }
  add(Item::guide, {&guide.mu, &guide.mu_static, &guide.viscous, &guide.preload});
  for (double& c : s.drive[0].c) add(Item::drive, {&c});
  for (Vec2* r : {&s.pin[0].a_at, &s.pin[0].b_at}) place(Item::pin, *r);
  Spring& spring = s.spring[0];
  for (Vec2* r : {&spring.a_at, &spring.b_at}) place(Item::spring, *r);
  add(Item::spring, {&spring.stiffness, &spring.length, &spring.damping});
  add(Item::joint_spring, {&s.joint_spring[0].stiffness, &s.joint_spring[0].rest, &s.joint_spring[0].damping});
  for (Vec2* r : {&s.load[0].at, &s.load[0].force}) place(Item::load, *r);
  add(Item::load, {&s.load[0].torque});
  expect_every(s, fields);
}

TEST(SceneDefects, PhysicalConstantsAreNotNegative) {
  Scene<Room> s = sound_scene();
  Guide& guide = s.guide[0];
  Spring& spring = s.spring[0];
  expect_every<double>(s, {{&s.alpha, Item::scene, Defect::negative_gain, {-1}},
                           {&s.beta, Item::scene, Defect::negative_gain, {-1}},
                           {&s.body[0].mass, Item::body, Defect::negative_mass, {-1}},
                           {&s.body[0].inertia, Item::body, Defect::negative_inertia, {-1}},
                           {&guide.mu, Item::guide, Defect::negative_mu, {-1}},
                           {&guide.mu, Item::guide, Defect::mu_static_below_mu, {1}},
                           {&guide.viscous, Item::guide, Defect::negative_viscous, {-1}},
                           {&guide.preload, Item::guide, Defect::negative_preload, {-1}},
                           {&spring.stiffness, Item::spring, Defect::negative_stiffness, {-1}},
                           {&spring.length, Item::spring, Defect::negative_length, {-1}},
                           {&spring.damping, Item::spring, Defect::negative_damping, {-1}},
                           {&s.joint_spring[0].stiffness, Item::joint_spring, Defect::negative_stiffness, {-1}},
                           {&s.joint_spring[0].damping, Item::joint_spring, Defect::negative_damping, {-1}}});
}

TEST(SceneDefects, IndicesNameWhatIsThere) {
  Scene<Room> s = sound_scene();
  Guide& guide = s.guide[0];
  Drive& drive = s.drive[0];
  Pin& pin = s.pin[0];
  Spring& spring = s.spring[0];
  const auto body = [](int* index, Item item) { return Field<int>{index, item, Defect::no_such_body, {-1, -2, 3}}; };
  const auto or_ground = [](int* index, Item item) { return Field<int>{index, item, Defect::no_such_body, {-2, 3}}; };
  expect_every<int>(s, {{&s.body[0].parent, Item::body, Defect::parent_not_earlier, {-2, 0, 1}},
                        body(&guide.slider, Item::guide),
                        or_ground(&guide.rail, Item::guide),
                        {&guide.rail, Item::guide, Defect::same_body, {1}},
                        {&guide.contacts, Item::guide, Defect::contact_count, {-1, 0, 3}},
                        body(&drive.body, Item::drive),
                        {&drive.axis, Item::drive, Defect::no_such_coordinate, {-1, 1}},
                        {&drive.terms, Item::drive, Defect::coefficient_count, {0, 9}},
                        {&drive.input, Item::drive, Defect::no_such_input, {none, 1}},
                        body(&pin.a, Item::pin),
                        or_ground(&pin.b, Item::pin),
                        {&pin.b, Item::pin, Defect::same_body, {2}},
                        body(&spring.a, Item::spring),
                        or_ground(&spring.b, Item::spring),
                        {&spring.b, Item::spring, Defect::same_body, {1}},
                        body(&s.joint_spring[0].body, Item::joint_spring),
                        {&s.joint_spring[0].body, Item::joint_spring, Defect::no_such_coordinate, {1}},
                        body(&s.load[0].body, Item::load),
                        {&s.load[0].input, Item::load, Defect::no_such_input, {-2, 1}}});
}

TEST(SceneDefects, ThereIsRoomForAllItems) {
  Scene<Room> s = sound_scene();
  const auto count = [](int* items, int room) {
    return Field<int>{items, Item::scene, Defect::too_large, {room + 1, -1}};
  };
  expect_every<int>(s, {count(&s.bodies, 4), count(&s.guides, 2), count(&s.drives, 2), count(&s.pins, 2),
                        count(&s.springs, 2), count(&s.joint_springs, 2), count(&s.loads, 2), count(&s.inputs, 2)});
  s.body[0].joint = Joint::planar;
  expect_told(s, Item::scene, Defect::too_large, "seven coordinates where there is room for five");
  s.body[0].joint = Joint::revolute;
  s.guides = 2;
  expect_told(s, Item::scene, Defect::too_large, "three contacts where there is room for two");
}

TEST(SceneDefects, TurnsAreRotationsByTheirAngles) {
  const auto expect_turn = [](double angle, Vec2 turn, bool is_sound) {
    Scene<Room> s = sound_scene();
    s.body[0].angle = angle;
    s.body[0].turn = turn;
    const std::string how = std::to_string(angle) + ": " + std::to_string(turn.x) + ", " + std::to_string(turn.y);
    if (!is_sound) return expect_told(s, Item::body, Defect::turn_not_a_rotation, how);
    EXPECT_EQ(defects(s).count, 0) << how;
    EXPECT_EQ(derive(s).turned[0], angle != 0) << how;
  };
  expect_turn(0, {1, 0}, true);
  expect_turn(0.5, {std::cos(0.5), std::sin(0.5)}, true);
  expect_turn(1e-9, {1, 1e-9}, true);  // the cosine is rounded to 1
  expect_turn(0.5, {1, 0}, false);
  expect_turn(0, {0, 1}, false);
  expect_turn(0, {1, 1e-9}, false);
  expect_turn(0.5, {1.1, 0}, false);
  expect_turn(0.5, {0.9, 0}, false);
}

TEST(SceneDefects, TangentsAreDirectionsOfLengthOne) {
  const auto expect_tangent = [](Vec2 direction, Vec2 tangent, bool is_sound) {
    Scene<Room> s = sound_scene();
    s.guide[0].direction = direction;
    s.guide[0].tangent = tangent;
    if (!is_sound) return expect_told(s, Item::guide, Defect::tangent_not_unit, std::to_string(tangent.x));
    EXPECT_EQ(defects(s).count, 0);
  };
  expect_tangent({3, 4}, {0.6, 0.8}, true);
  expect_tangent({-3, -4}, {-0.6, -0.8}, true);
  expect_tangent({3, 4}, {-0.6, -0.8}, false);
  expect_tangent({3, 4}, {0.8, 0.6}, false);
  expect_tangent({4, 3}, {0.6, 0.8}, false);
  expect_tangent({3, 4}, {3, 4}, false);
  expect_tangent({3, 4}, {0.3, 0.4}, false);
  Scene<Room> s = sound_scene();
  s.guide[0].direction = {0, 0};
  expect_told(s, Item::guide, Defect::no_direction, "0, 0");
}

TEST(RoughSquareRoot, IsFromAboveAThousandthOff) {
  for (double x = 1e-299; x < 1e299; x *= 7.3) {
    const double root = detail::rough_sqrt(x);
    EXPECT_GE(root, std::sqrt(x) * (1 - 1e-15)) << x;
    EXPECT_LE(root, std::sqrt(x) * 1.001) << x;
    EXPECT_EQ(detail::rough_sqrt(4 * x), 2 * root) << "in another unit";
  }
  for (const double x : {0.0, 1e-301, 1e301, infinity}) EXPECT_EQ(detail::rough_sqrt(x), x) << "is left as it is";
}

}  // namespace
