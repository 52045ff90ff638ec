#include "engines.hpp"

namespace slideway::charts {

namespace {
void add_simbody(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders);
std::string simbody_version();
}  // namespace

Engine simbody_engine() {
  return {
      "Simbody",
      simbody_version(),
      "friction of a joint at all: it is a user's force. Friction bounded by the joint's own force in the same step: "
      "that is known after forces are asked for, so that the bound is constant, or set from the last step's force. "
      "Rest: such a force has to be smooth in speed",
      "Simbody: smooth friction, creeps",
      add_simbody,
      {EngineFriction::constant, EngineFriction::last_step}};
}

}  // namespace slideway::charts

#ifndef SLIDEWAY_SIMBODY

namespace slideway::charts {
namespace {
void add_simbody(const CrankMechanism&, EngineFriction, Contenders&) {}
std::string simbody_version() { return ""; }
}  // namespace
}  // namespace slideway::charts

#else

#include <Simbody.h>
#include <fmt/format.h>

#include <cmath>

namespace slideway::charts {
namespace {

std::string simbody_version() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return fmt::format("{}.{}.{}", major, minor, build);
}

/// Reaction forces are known after the accelerations alone, which forces come before.
class BoundFriction final : public SimTK::Force::Custom::Implementation {
 public:
  BoundFriction(const SimTK::MobilizedBody& slide, double width, const double& bound)
      : slide_(slide), width_(width), bound_(bound) {}
  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>&, SimTK::Vector_<SimTK::Vec3>&,
                 SimTK::Vector& mobility_forces) const override {
    slide_.applyOneMobilityForce(state, 0, -bound_ * std::tanh(slide_.getOneU(state, 0) / width_), mobility_forces);
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0; }

 private:
  const SimTK::MobilizedBody& slide_;
  double width_;
  const double& bound_;
};

/// Without CPodes: its functions have names of SUNDIALS's, which would be called instead in this program.
enum class SimbodyMethod { runge_kutta_merson, runge_kutta_feldberg, semi_explicit_euler };

class SimbodyContender final : public Contender {
 public:
  SimbodyContender(const CrankMechanism& mechanism, EngineFriction friction, SimbodyMethod method, double width)
      : mechanism_(mechanism), friction_(friction), method_(method) {
    family = family_of("Simbody", friction);
    name = method == SimbodyMethod::runge_kutta_merson     ? "RungeKuttaMerson"
           : method == SimbodyMethod::runge_kutta_feldberg ? "RungeKuttaFeldberg"
                                                           : "SemiExplicitEuler";
    if (friction != EngineFriction::none) name += fmt::format(", tanh(v / {:g} m/s)", width);
    if (method == SimbodyMethod::semi_explicit_euler) {
      setting = "step";
      settings = engine_steps(mechanism.interval);
    } else {
      setting = "accuracy";
      for (int k = 2; k <= 24; ++k) settings.push_back(std::pow(10, -k / 2.0));
    }
    make_system(width);
  }

  Outcome run(const std::vector<double>& times, double how) const override {
    Outcome outcome;
    try {
      advance(times, how, outcome);
    } catch (const std::exception&) {
      outcome.failure = "the engine failed";
    }
    return outcome;
  }

 private:
  SimTK::MobilizedBody& mobile(int i) { return i == ground ? matter_.updGround() : mobile_[i]; }

  void make_system(double width) {
    using namespace SimTK;
    const RunScene& scene = mechanism_.scene;
    const Guide& guide = mechanism_.guide();
    const auto shape = [&](int i) {
      const Vec3 com(scene.body[i].com.x, scene.body[i].com.y, 0);
      return SimTK::Body::Rigid(MassProperties(
          scene.body[i].mass, com, Inertia(scene.body[i].inertia).shiftFromMassCenter(com, scene.body[i].mass)));
    };
    for (int i = 0; i < scene.bodies; ++i) {
      if (i == mechanism_.slider) continue;
      const Vec3 at(scene.body[i].at.x, scene.body[i].at.y, 0);
      mobile_[i] = MobilizedBody::Pin(mobile(scene.body[i].parent), Transform(at), shape(i), Transform());
    }
    const SimTK::Rotation along(std::atan2(guide.tangent.y, guide.tangent.x), ZAxis);
    mobile_[mechanism_.slider] =
        MobilizedBody::Slider(mobile(mechanism_.rail), Transform(along, Vec3(guide.origin.x, guide.origin.y, 0)),
                              shape(mechanism_.slider), Transform());
    const Vec2 at = scene.body[mechanism_.slider].at;
    for (const UnitVec3& normal : {UnitVec3(1, 0, 0), UnitVec3(0, 1, 0)}) {
      Constraint::PointInPlane(mobile(mechanism_.slider), normal, 0, mobile(mechanism_.carrier), Vec3(at.x, at.y, 0));
    }
    Force::UniformGravity(forces_, matter_, Vec3(scene.gravity.x, scene.gravity.y, 0));
    if (friction_ != EngineFriction::none) {
      Force::Custom(forces_, new BoundFriction(mobile(mechanism_.slider), width, bound_));  // Simbody deletes it
    }
    system_.realizeTopology();
    start_ = system_.getDefaultState();
    for (int i = 0; i < scene.bodies; ++i) {
      const bool slides = i == mechanism_.slider;
      mobile_[i].setOneQ(start_, 0, slides ? mechanism_.along : scene.body[i].q[0]);
      mobile_[i].setOneU(start_, 0, slides ? mechanism_.along_rate : scene.body[i].v[0]);
    }
  }

  std::unique_ptr<SimTK::Integrator> make_integrator(double how) const {
    switch (method_) {
      case SimbodyMethod::runge_kutta_merson:
        return std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
      case SimbodyMethod::runge_kutta_feldberg:
        return std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system_);
      case SimbodyMethod::semi_explicit_euler:
        break;
    }
    return std::make_unique<SimTK::SemiExplicitEulerIntegrator>(system_, how);
  }

  void advance(const std::vector<double>& times, double how, Outcome& outcome) const {
    bound_ = mechanism_.guide().mu * mechanism_.even_force;
    const auto integrator = make_integrator(how);
    if (setting == "accuracy") integrator->setAccuracy(how);
    if (friction_ == EngineFriction::last_step) {
      integrator->setReturnEveryInternalStep(true);
      integrator->setAllowInterpolation(false);
      follow_reaction(start_);
    }
    integrator->initialize(start_);
    double angle[Size::bodies];
    for (const double to : times) {
      while (integrator->getTime() < to) {
        const auto came_to = integrator->stepTo(to, to);
        const bool moved = came_to != SimTK::Integrator::StartOfContinuousInterval;
        if (friction_ != EngineFriction::last_step || !moved) continue;
        follow_reaction(integrator->getState());
        integrator->reinitialize(SimTK::Stage::Dynamics, false);
      }
      const SimTK::State& state = integrator->getState();
      for (int i = 0; i < mechanism_.scene.bodies; ++i) {
        const int parent = mechanism_.scene.body[i].parent;
        if (i != mechanism_.slider) angle[i] = (parent == ground ? 0 : angle[parent]) + mobile_[i].getOneQ(state, 0);
      }
      angle[mechanism_.slider] = mechanism_.rail == ground ? 0 : angle[mechanism_.rail];
      outcome.q.push_back(mechanism_.joints(angle));
      outcome.lambda.emplace_back();  // not asked for
    }
    outcome.evaluations = integrator->getNumRealizations();
  }

  void follow_reaction(const SimTK::State& state) const {
    system_.realize(state, SimTK::Stage::Acceleration);
    const SimTK::MobilizedBody& slider = mobile_[mechanism_.slider];
    const SimTK::SpatialVec wrench = slider.findMobilizerReactionOnBodyAtOriginInGround(state);
    const SimTK::Vec3 n = slider.getBodyRotation(state) * SimTK::Vec3(0, 1, 0);
    bound_ = mechanism_.bound(SimTK::dot(n, wrench[1]), wrench[0][2]);
  }

  const CrankMechanism& mechanism_;
  EngineFriction friction_;
  SimbodyMethod method_;
  mutable double bound_ = 0;  ///< of a run: set anew by each
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  SimTK::MobilizedBody mobile_[Size::bodies];
  SimTK::State start_;
};

void add_simbody(const CrankMechanism& mechanism, EngineFriction friction, Contenders& contenders) {
  const std::vector<double> widths =
      friction == EngineFriction::none ? std::vector<double>{1} : std::vector<double>{1e-2, 1e-3, 1e-4};
  for (const SimbodyMethod method :
       {SimbodyMethod::runge_kutta_merson, SimbodyMethod::runge_kutta_feldberg, SimbodyMethod::semi_explicit_euler}) {
    for (const double width : widths) {
      contenders.push_back(std::make_unique<SimbodyContender>(mechanism, friction, method, width));
    }
  }
}

}  // namespace
}  // namespace slideway::charts

#endif
