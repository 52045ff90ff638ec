// The drawn mechanisms are what they are said to be.
#include <cmath>
#include <cstring>
#include <slideway/io/start.hpp>
#include <slideway/properties/rapidcheck.hpp>

namespace {

using namespace slideway;
using namespace slideway::properties;

RC_GTEST_PROP(MechanismProperty, IsASceneWithoutDefects, (const Mechanism& mechanism)) {
  RC_ASSERT(defects(mechanism.scene).count == 0);
  RC_CLASSIFY(mechanism.assembled, "assembled");
  RC_CLASSIFY(mechanism.scene.guides > 1, "several guides");
  RC_CLASSIFY(mechanism.scene.drives > 0, "driven");
  RC_CLASSIFY(mechanism.scene.pins > 0, "with a loop");
}

/// As a file it is the same scene, and its start passes the reader's checks.
RC_GTEST_PROP(MechanismProperty, ReadsBackFromItsFile, (const Mechanism& mechanism)) {
  const io::Reading reading = io::parse_scene(toml(mechanism.scene), "drawn.toml");
  for (const io::FileDefect& defect : reading.defects) RC_FAIL(to_string(defect));
  const MechanismScene& read = reading.scene->scene;
  const MechanismScene& drawn = mechanism.scene;
  RC_ASSERT(read.bodies == drawn.bodies && read.guides == drawn.guides && read.drives == drawn.drives &&
            read.pins == drawn.pins && read.springs == drawn.springs && read.joint_springs == drawn.joint_springs &&
            read.loads == drawn.loads);
  for (int i = 0; i < drawn.bodies; ++i) {
    const Body &a = read.body[i], &b = drawn.body[i];
    RC_ASSERT(a.parent == b.parent && a.joint == b.joint && a.mass == b.mass && a.inertia == b.inertia);
    RC_ASSERT(a.at.x == b.at.x && a.at.y == b.at.y && a.turn.x == b.turn.x && a.turn.y == b.turn.y);
    bool driven = false;
    for (int d = 0; d < drawn.drives; ++d) driven = driven || drawn.drive[d].body == i;
    for (int k = 0; k < coordinates(b.joint) && !driven; ++k) RC_ASSERT(a.q[k] == b.q[k] && a.v[k] == b.v[k]);
  }
  for (int g = 0; g < drawn.guides; ++g) {
    const Guide &a = read.guide[g], &b = drawn.guide[g];
    RC_ASSERT(a.slider == b.slider && a.rail == b.rail && a.contacts == b.contacts && a.mu == b.mu &&
              a.mu_static == b.mu_static && a.viscous == b.viscous && a.preload == b.preload);
    RC_ASSERT(a.origin.x == b.origin.x && a.origin.y == b.origin.y && a.contact[1].y == b.contact[1].y);
  }
  for (int d = 0; d < drawn.drives; ++d) {
    RC_ASSERT(read.drive[d].law == drawn.drive[d].law && read.drive[d].axis == drawn.drive[d].axis);
    RC_ASSERT(std::equal(std::begin(read.drive[d].c), std::end(read.drive[d].c), std::begin(drawn.drive[d].c)));
  }
  if (mechanism.assembled) {
    for (const io::FileDefect& defect : io::check_start(*reading.scene)) RC_FAIL(to_string(defect));
  }
}

}  // namespace
