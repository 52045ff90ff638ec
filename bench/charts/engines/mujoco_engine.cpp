#include "engines.hpp"

namespace slideway::charts {

namespace {
void add_mujoco(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders);
const char* mujoco_version();
}  // namespace

Engine mujoco_engine() {
  return {
      "MuJoCo",
      mujoco_version(),
      "friction bounded by a joint's own force in the same step: the bound is constant, or set from the last step's "
      "force. Rigid constraints: they give way, the default ones visibly. Rest: a slider that is held creeps",
      "MuJoCo: soft constraints, creeps",
      add_mujoco,
      {EngineFriction::constant, EngineFriction::last_step}};
}

}  // namespace slideway::charts

#ifndef SLIDEWAY_MUJOCO

namespace slideway::charts {
namespace {
void add_mujoco(const CrankMechanism&, EngineFriction, Contenders&) {}
const char* mujoco_version() { return ""; }
}  // namespace
}  // namespace slideway::charts

#else

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace slideway::charts {
namespace {

const char* mujoco_version() { return mj_versionString(); }

/// Bodies in MJCF, nested as their parents are; the slider below its rail.
std::string body_xml(const CrankMechanism& mechanism, int i, bool frictional) {
  const Body& body = mechanism.scene.body[i];
  const Guide& guide = mechanism.guide();
  const bool slides = i == mechanism.slider;
  std::string xml;
  if (slides) {
    xml = fmt::format(
        "<body name=\"b{}\" pos=\"{:.17g} {:.17g} 0\"><joint type=\"slide\" axis=\"{:.17g} {:.17g} 0\"{}/>", i,
        guide.origin.x, guide.origin.y, guide.tangent.x, guide.tangent.y, frictional ? " frictionloss=\"1\"" : "");
  } else {
    xml = fmt::format("<body name=\"b{}\" pos=\"{:.17g} {:.17g} 0\"><joint type=\"hinge\" axis=\"0 0 1\"/>", i,
                      body.at.x, body.at.y);
  }
  // The moments about x and y do nothing in the plane.
  xml += fmt::format(
      "<inertial pos=\"{0:.17g} {1:.17g} 0\" mass=\"{2:.17g}\" diaginertia=\"{3:.17g} {3:.17g} {3:.17g}\"/>",
      body.com.x, body.com.y, body.mass, body.inertia);
  for (int k = 0; k < mechanism.scene.bodies; ++k) {
    const int parent = k == mechanism.slider ? mechanism.rail : mechanism.scene.body[k].parent;
    if (parent == i) xml += body_xml(mechanism, k, frictional);
  }
  return xml + "</body>";
}

std::string model_xml(const CrankMechanism& mechanism, bool frictional) {
  const Vec2 g = mechanism.scene.gravity, at = mechanism.scene.body[mechanism.slider].at;
  std::string xml = fmt::format(
      "<mujoco><compiler angle=\"radian\"/><option gravity=\"{:.17g} {:.17g} 0\"><flag contact=\"disable\"/></option>"
      "<worldbody>",
      g.x, g.y);
  for (int i = 0; i < mechanism.scene.bodies; ++i) {
    const int parent = i == mechanism.slider ? mechanism.rail : mechanism.scene.body[i].parent;
    if (parent == ground) xml += body_xml(mechanism, i, frictional);
  }
  xml += fmt::format(
      "</worldbody><equality><connect body1=\"b{}\" body2=\"b{}\" anchor=\"{:.17g} {:.17g} 0\"/></equality></mujoco>",
      mechanism.carrier, mechanism.slider, at.x, at.y);
  return xml;
}

struct MujocoChoice {
  mjtIntegrator integrator;
  mjtSolver solver;
  double tolerance;
  bool stiff;  ///< constraints as hard as the engine lets them be: impedance 0.9999, time constant 2 steps
};

class MujocoModel {
 public:
  MujocoModel(const CrankMechanism& mechanism, EngineFriction friction, const MujocoChoice& choice)
      : mechanism_(mechanism),
        friction_(friction),
        stiff_(choice.stiff),
        model_(load(model_xml(mechanism, friction != EngineFriction::none)), mj_deleteModel),
        data_(mj_makeData(model_.get()), mj_deleteData) {
    model_->opt.integrator = choice.integrator;
    model_->opt.solver = choice.solver;
    model_->opt.tolerance = choice.tolerance;
    // Where the loop closes was taken from a pose that it does not close in.
    for (int k = 3; k < 6; ++k) model_->eq_data[k] = 0;
    for (int i = 0; i < mechanism.scene.bodies; ++i) {
      const int id = mj_name2id(model_.get(), mjOBJ_BODY, fmt::format("b{}", i).c_str());
      body_[i] = id;
      address_[i] = model_->jnt_qposadr[model_->body_jntadr[id]];
    }
  }

  void start(double h) {
    mj_resetData(model_.get(), data_.get());
    if (stiff_) {
      harden(model_->eq_solref, model_->eq_solimp, h);
      for (int k = 0; k < model_->nv; ++k) harden(model_->dof_solref + mjNREF * k, model_->dof_solimp + mjNIMP * k, h);
    }
    for (int i = 0; i < mechanism_.scene.bodies; ++i) {
      data_->qpos[address_[i]] = i == mechanism_.slider ? mechanism_.along : mechanism_.scene.body[i].q[0];
      data_->qvel[address_[i]] = i == mechanism_.slider ? mechanism_.along_rate : mechanism_.scene.body[i].v[0];
    }
    set_bound(mechanism_.guide().mu * mechanism_.even_force);
    if (friction_ != EngineFriction::last_step) return;
    mj_forward(model_.get(), data_.get());
    follow_reaction();
  }

  bool step(double h) {
    model_->opt.timestep = h;
    mj_step(model_.get(), data_.get());
    if (friction_ == EngineFriction::last_step) follow_reaction();
    return data_->warning[mjWARN_BADQACC].number == 0 && data_->warning[mjWARN_BADQPOS].number == 0;
  }

  void angles(double* angle) const {
    for (int i = 0; i < mechanism_.scene.bodies; ++i) {
      const int parent = mechanism_.scene.body[i].parent;
      if (i != mechanism_.slider) angle[i] = (parent == ground ? 0 : angle[parent]) + data_->qpos[address_[i]];
    }
    angle[mechanism_.slider] = mechanism_.rail == ground ? 0 : angle[mechanism_.rail];
  }

 private:
  static mjModel* load(const std::string& xml) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "model.xml")], xml.data(), xml.size());
    char error[500] = "";
    mjModel* model = mj_loadXML("model.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (model == nullptr) throw std::runtime_error(fmt::format("MuJoCo: {}", error));
    return model;
  }

  static void harden(mjtNum* reference, mjtNum* impedance, double h) {
    reference[0] = 2 * h;  // the least that is stable, and that refsafe lets pass
    impedance[0] = impedance[1] = mjMAXIMP;
  }

  void set_bound(double bound) {
    if (friction_ != EngineFriction::none) model_->dof_frictionloss[address_[mechanism_.slider]] = bound;
  }

  /// The rail's force on the slider, about the centre of mass of the tree that it is in.
  void follow_reaction() {
    mj_rnePostConstraint(model_.get(), data_.get());
    const int id = body_[mechanism_.slider];
    const mjtNum *wrench = data_->cfrc_int + 6 * id, *centre = data_->subtree_com + 3 * model_->body_rootid[id];
    const mjtNum *turn = data_->xmat + 9 * id, *place = data_->xpos + 3 * id;
    const Vec2 t = mechanism_.guide().tangent, force{wrench[3], wrench[4]};
    const Vec2 n{-(turn[3] * t.x + turn[4] * t.y), turn[0] * t.x + turn[1] * t.y};
    set_bound(
        mechanism_.bound(dot(n, force), wrench[2] - cross(Vec2{place[0] - centre[0], place[1] - centre[1]}, force)));
  }

  const CrankMechanism& mechanism_;
  EngineFriction friction_;
  bool stiff_;
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  int address_[Size::bodies], body_[Size::bodies];
};

void add_mujoco(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders) {
  struct Named {
    const char* name;
    MujocoChoice choice;
  };
  for (const auto& [integrator, integrator_name] :
       {std::pair{mjINT_EULER, "Euler"}, {mjINT_RK4, "RK4"}, {mjINT_IMPLICIT, "implicit"}}) {
    for (const Named& solver : {Named{"Newton", {integrator, mjSOL_NEWTON, 1e-8, false}},
                                {"Newton, tolerance 1e-14", {integrator, mjSOL_NEWTON, 1e-14, false}},
                                {"CG", {integrator, mjSOL_CG, 1e-8, false}},
                                {"PGS", {integrator, mjSOL_PGS, 1e-8, false}}}) {
      for (const bool stiff : {false, true}) {
        MujocoChoice choice = solver.choice;
        choice.stiff = stiff;
        auto contender = std::make_unique<SteppedEngine<MujocoModel> >(
            mechanism, family_of("MuJoCo", friction),
            fmt::format("{}, {}, {} constraints", integrator_name, solver.name, stiff ? "stiff" : "default"), friction,
            choice);
        contender->settings = engine_steps(mechanism.interval);
        contenders.push_back(std::move(contender));
      }
    }
  }
}

}  // namespace
}  // namespace slideway::charts

#endif
