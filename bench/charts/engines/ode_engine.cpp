#include "engines.hpp"

namespace slideway::charts {

namespace {
void add_ode(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders);
const char* ode_version();
}  // namespace

Engine ode_engine() {
  return {
      "ODE",
      ode_version(),
      "friction bounded by a joint's own force in the same step: a slide joint's bound is constant, or set from the "
      "last step's force. Of contacts dWorldStep bounds friction by forces that it finds without friction, "
      "dWorldQuickStep by those that its iteration has come to. Rest by dWorldQuickStep: the slider creeps. An order "
      "of more than 1",
      "ODE: order 1",
      add_ode,
      {EngineFriction::constant, EngineFriction::last_step, EngineFriction::contact_pair}};
}

}  // namespace slideway::charts

#ifndef SLIDEWAY_ODE

namespace slideway::charts {
namespace {
void add_ode(const CrankMechanism&, EngineFriction, Contenders&) {}
const char* ode_version() { return ""; }
}  // namespace
}  // namespace slideway::charts

#else

#include <fmt/format.h>
#include <ode/ode.h>

#include <cmath>

namespace slideway::charts {
namespace {

const char* ode_version() { return dODE_VERSION; }

/// Initialised once; its bodies are placed by their centres of mass.
struct OdeLibrary {
  OdeLibrary() { dInitODE2(0); }
  ~OdeLibrary() { dCloseODE(); }
};

class OdeModel {
 public:
  /// `iterations` of dWorldQuickStep; 0: dWorldStep.
  OdeModel(const CrankMechanism& mechanism, EngineFriction friction, int iterations)
      : mechanism_(mechanism), friction_(friction), iterations_(iterations) {
    static const OdeLibrary library;
  }

  void start(double) {
    contacts_.reset(dJointGroupCreate(0));
    world_.reset(dWorldCreate());
    const RunScene& scene = mechanism_.scene;
    dWorldSetGravity(world_.get(), scene.gravity.x, scene.gravity.y, 0);
    if (iterations_ > 0) dWorldSetQuickStepNumIterations(world_.get(), iterations_);
    for (int i = 0; i < scene.bodies; ++i) make_body(i);
    for (int i = 0; i < scene.bodies; ++i) {
      const dJointID hinge = dJointCreateHinge(world_.get(), nullptr);
      const int parent = scene.body[i].parent;
      dJointAttach(hinge, body_[i], parent == ground ? nullptr : body_[parent]);
      dJointSetHingeAnchor(hinge, mechanism_.x[3 * i], mechanism_.x[3 * i + 1], 0);
      dJointSetHingeAxis(hinge, 0, 0, 1);
    }
    if (friction_ == EngineFriction::contact_pair) return;
    slide_ = dJointCreateSlider(world_.get(), nullptr);
    dJointAttach(slide_, body_[mechanism_.slider], rail());
    const Vec2 t = mechanism_.tangent();
    dJointSetSliderAxis(slide_, t.x, t.y, 0);
    dJointSetFeedback(slide_, &feedback_);
    if (friction_ == EngineFriction::none) return;
    dJointSetSliderParam(slide_, dParamVel, 0);
    dJointSetSliderParam(slide_, dParamFMax, mechanism_.guide().mu * mechanism_.even_force);
  }

  bool step(double h) {
    if (friction_ == EngineFriction::contact_pair) touch();
    const int done = iterations_ > 0 ? dWorldQuickStep(world_.get(), h) : dWorldStep(world_.get(), h);
    if (friction_ == EngineFriction::contact_pair) dJointGroupEmpty(contacts_.get());
    if (friction_ == EngineFriction::last_step) {
      const Vec2 t = tangent();
      const double n = -t.y * feedback_.f1[0] + t.x * feedback_.f1[1];
      dJointSetSliderParam(slide_, dParamFMax, mechanism_.bound(n, feedback_.t1[2]));
    }
    return done != 0 && std::isfinite(dBodyGetPosition(body_[0])[0]);
  }

  void angles(double* angle) const {
    for (int i = 0; i < mechanism_.scene.bodies; ++i) {
      const dReal* turn = dBodyGetRotation(body_[i]);
      angle[i] = std::atan2(turn[4], turn[0]);
    }
  }

 private:
  void make_body(int i) {
    const Body& body = mechanism_.scene.body[i];
    const double *x = mechanism_.x + 3 * i, *u = mechanism_.u + 3 * i;
    body_[i] = dBodyCreate(world_.get());
    dMass mass;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, body.inertia, body.inertia, body.inertia, 0, 0, 0);
    dBodySetMass(body_[i], &mass);
    const Vec2 com = Rotation{std::cos(x[2]), std::sin(x[2])} * body.com, speed = u[2] * perp(com);
    dMatrix3 turn;
    dRFromAxisAndAngle(turn, 0, 0, 1, x[2]);
    dBodySetRotation(body_[i], turn);
    dBodySetPosition(body_[i], x[0] + com.x, x[1] + com.y, 0);
    dBodySetLinearVel(body_[i], u[0] + speed.x, u[1] + speed.y, 0);
    dBodySetAngularVel(body_[i], 0, 0, u[2]);
  }

  dBodyID rail() const { return mechanism_.rail == ground ? nullptr : body_[mechanism_.rail]; }

  /// A point of the rail, in the rail's frame, and the guide's direction, in the world's.
  Vec2 rail_point(Vec2 at) const {
    if (rail() == nullptr) return at;
    const Vec2 com = mechanism_.scene.body[mechanism_.rail].com;
    dVector3 place;
    dBodyGetRelPointPos(rail(), at.x - com.x, at.y - com.y, 0, place);
    return {place[0], place[1]};
  }
  Vec2 tangent() const {
    const Guide& guide = mechanism_.guide();
    return rail_point(guide.origin + guide.tangent) - rail_point(guide.origin);
  }

  /// Each contact point touches the side of the slot that it is beyond, as where collisions are looked for: joints for
  /// both sides at once press against each other, and their friction holds the slider.
  void touch() {
    const Guide& guide = mechanism_.guide();
    const Vec2 t = tangent(), n = perp(t), origin = rail_point(guide.origin);
    const Vec2 com = mechanism_.scene.body[mechanism_.slider].com;
    for (const Vec2 at : guide.contact) {
      dContact contact = {};
      contact.surface.mode = dContactApprox1 | dContactFDir1 | dContactMu2;
      contact.surface.mu = guide.mu;
      dBodyGetRelPointPos(body_[mechanism_.slider], at.x - com.x, at.y - com.y, 0, contact.geom.pos);
      const double gap = dot(n, Vec2{contact.geom.pos[0], contact.geom.pos[1]} - origin);
      contact.fdir1[0] = t.x;
      contact.fdir1[1] = t.y;
      const double side = gap > 0 ? -1 : 1;
      contact.geom.normal[0] = side * n.x;
      contact.geom.normal[1] = side * n.y;
      contact.geom.depth = std::fabs(gap);
      dJointAttach(dJointCreateContact(world_.get(), contacts_.get(), &contact), body_[mechanism_.slider], rail());
    }
  }

  const CrankMechanism& mechanism_;
  EngineFriction friction_;
  int iterations_;
  std::unique_ptr<dxWorld, void (*)(dWorldID)> world_{nullptr, dWorldDestroy};
  std::unique_ptr<dxJointGroup, void (*)(dJointGroupID)> contacts_{nullptr, dJointGroupDestroy};
  dBodyID body_[Size::bodies] = {};
  dJointID slide_ = nullptr;
  dJointFeedback feedback_ = {};
};

void add_ode(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders) {
  for (const int iterations : {0, 20, 50, 200}) {
    const std::string name = iterations == 0 ? "dWorldStep" : fmt::format("dWorldQuickStep, {} iterations", iterations);
    auto contender =
        std::make_unique<SteppedEngine<OdeModel> >(mechanism, family_of("ODE", friction), name, friction, iterations);
    contender->settings = engine_steps(mechanism.interval);
    contenders.push_back(std::move(contender));
  }
}

}  // namespace
}  // namespace slideway::charts

#endif
