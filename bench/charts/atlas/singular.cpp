// Approach to a singular pose: distance from it, as far as the oracle (S of 1e-30 counts as zero) tells it, against the
// coefficient of friction. Judge: the oracle, in 50 digits, at the state in doubles. Beside the kernel the whole system
// by LU with partial pivoting, which never refuses.
#include <cmath>

#include "exact_instant.hpp"
#include "full_system.hpp"

namespace slideway::charts {
namespace {

using MakeScene = std::function<RunScene(double distance, double mu)>;

struct Pose {
  std::string name, title, distance;
  MakeScene scene;
};

/// Crank and rod of equal length, the crank's angle short of 90 degrees by the distance: there the rod folds back and
/// the guide holds it no more.
Pose dead_centre(const AtlasOptions& options) {
  const RunScene given = options.scene("slider_crank_equal");
  return {"dead_centre", "Slider-crank near its dead centre", "angle left, rad", [given](double distance, double mu) {
            RunScene scene = given;
            const double crank = std::acos(0.0) - distance;
            scene.drive[0].c[0] = scene.body[0].q[0] = crank;
            scene.body[0].v[0] = scene.drive[0].c[1];
            scene.body[1].q[0] = -2 * crank;
            scene.body[1].v[0] = -2 * scene.drive[0].c[1];
            scene.guide[0].mu = scene.guide[0].mu_static = mu;
            return scene;
          }};
}

/// A body with one point on the x axis and another, 1 m above, on a line that is inclined by the distance.
Pose parallel_guides(const AtlasOptions&) {
  return {"parallel_guides", "Two guides, nearly parallel", "angle between the guides, rad",
          [](double distance, double mu) {
            RunScene scene;
            scene.gravity = {0, -9.81};
            scene.bodies = 1;
            Body& body = scene.body[0];
            body.joint = Joint::planar;
            body.mass = 1;
            body.inertia = 0.1;
            body.com = {0, 0.5};
            body.v[0] = body.v[2] = 1;
            scene.guides = 2;
            for (int g = 0; g < 2; ++g) {
              scene.guide[g].contact[0] = {0, static_cast<double>(g)};
              scene.guide[g].origin = scene.guide[g].contact[0];
              scene.guide[g].mu = scene.guide[g].mu_static = mu;
            }
            scene.guide[1].direction = scene.guide[1].tangent = {std::cos(distance), std::sin(distance)};
            return scene;
          }};
}

/// The overhung slider as its contacts come together.
Pose close_contacts(const AtlasOptions& options) {
  const RunScene given = options.scene("overhung_slider");
  return {"close_contacts", "Two contacts of one slider, close together", "half their distance, m",
          [given](double distance, double mu) {
            RunScene scene = given;
            scene.guide[0].contact[0].x = -distance;
            scene.guide[0].contact[1].x = distance;
            scene.guide[0].mu = scene.guide[0].mu_static = mu;
            return scene;
          }};
}

}  // namespace

AtlasMap draw_singular(const AtlasOptions& options) {
  AtlasMap map = begin_map("singular");
  for (const auto make : {dead_centre, parallel_guides, close_contacts}) {
    const Pose pose = make(options);
    const Grid grid{{pose.distance, 1, 1e-14, true},
                    {"coefficient of friction", 1e-14, 1, true},
                    options.quick ? 14 : 56,
                    options.quick ? 7 : 42};
    std::vector<Cell> by_kernel, by_lu;
    judge_cells(grid, [&](double distance, double mu) {
      const RunScene scene = pose.scene(distance, mu);
      const io::RunStepper stepper(scene);
      const ExactInstant exact(scene, stepper.start());
      constexpr double tolerance = 1e-6;  // six digits, or what rounding the state leaves
      by_kernel.push_back(exact.judge(stepper, tolerance));
      by_lu.push_back(exact.judge(forces_by_lu(scene, stepper.start()), tolerance));
      return Cell::right;
    });
    add_cells(map, {pose.name + "_slideway", "slideway", pose.title}, grid, by_kernel);
    add_cells(map, {pose.name + "_lu", "the whole system, LU, signs by iteration", pose.title}, grid, by_lu);
  }
  return map;
}

}  // namespace slideway::charts
