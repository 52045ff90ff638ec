#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <slideway/dynamics.hpp>
#include <slideway/io/start.hpp>

namespace slideway::io {
namespace {

using Source = RunTime<RunSize>;

/// The scene in its start pose. On the heap: together these have the size of a small stack.
struct StartPose {
  Source source;
  double q[RunSize::coordinates] = {}, v[RunSize::coordinates] = {};
  Kinematics<RunSize> kinematics;
  Dynamics<RunSize> dynamics;

  explicit StartPose(const Scene<RunSize>& scene) : source(scene) {
    for (int i = 0, j = 0; i < scene.bodies; ++i) {
      for (int k = 0; k < coordinates(scene.body[i].joint); ++k, ++j) {
        q[j] = scene.body[i].q[k];
        v[j] = scene.body[i].v[k];
      }
    }
    const double no_acceleration[RunSize::coordinates] = {};
    slideway::kinematics(source, q, v, no_acceleration, kinematics);
  }

  /// The speed that the rates of constraints are measured against: of bodies' origins, and of points one length of the
  /// scene away from them, m/s.
  double largest_speed() const {
    double most = 0;
    for (int i = 0; i < source.scene.bodies; ++i) {
      const Vec2 speed = kinematics.velocity[i];
      const double turning = std::fabs(kinematics.rate[i]) * source.tables.length;
      most = std::max({most, turning, source.tables.moving[i] ? std::hypot(speed.x, speed.y) : 0.0});
    }
    return most;
  }
};

/// Adds a defect when a constraint's miss is beyond the tolerance.
struct MissReport {
  const SceneFile& file;
  double length, speed;
  std::vector<FileDefect>& defects;

  void operator()(Item item, int index, const char* what, double miss, double rate) const {
    const std::string title = file.title(item, index);
    if (!(miss <= start_tolerance * length)) {
      defects.push_back({file.file, file.line(item, index),
                         fmt::format("{}: the start misses {} by {:.3g} m: correct q, or let --project-start do it",
                                     title, what, miss)});
    } else if (!(rate <= start_tolerance * speed + detail::epsilon * length)) {  // in a second, rounding of the length
      defects.push_back({file.file, file.line(item, index),
                         fmt::format("{}: the start speeds leave {} at {:.3g} m/s: correct v, or let --project-start "
                                     "do it",
                                     title, what, rate)});
    }
  }
};

}  // namespace

std::vector<FileDefect> check_masses(const SceneFile& file) {
  const auto pose = std::make_unique<StartPose>(file.scene);
  const Inputs<RunSize> no_inputs;
  apply_forces(pose->source, pose->kinematics, no_inputs, 0, pose->dynamics);
  gather(pose->source, pose->kinematics, pose->dynamics);
  if (factor_mass(pose->source, pose->kinematics, pose->q, pose->v, pose->dynamics)) return {};
  const auto& table = pose->source.tables;
  for (int f = table.free - 1; f >= 0; --f) {  // in the order of the elimination: the first that fails is to blame
    const double root = pose->dynamics.M[f][f];
    if (root * root > table.free * detail::epsilon * pose->dynamics.diagonal[f]) continue;
    const int body = table.body_of[table.free_coordinate[f]];
    return {{file.file, file.line(Item::body, body),
             fmt::format("{} needs mass or inertia, its own or of what it carries: nothing resists its undriven "
                         "coordinate",
                         file.title(Item::body, body))}};
  }
  return {{file.file, 0, "scene needs a mass matrix that is definite"}};
}

std::vector<FileDefect> check_start(const SceneFile& file) {
  const auto pose = std::make_unique<StartPose>(file.scene);
  const auto& source = pose->source;
  std::vector<FileDefect> defects;
  const MissReport report{file, source.tables.length, pose->largest_speed(), defects};
  for (int g = 0; g < file.scene.guides; ++g) {
    double miss = 0, rate = 0;
    Sliding at;
    sliding(source, pose->kinematics, g, at);
    for (int k = 0; k < file.scene.guide[g].contacts; ++k) {
      miss = std::fmax(miss, std::fabs(at.Phi[k]));
      rate = std::fmax(rate, std::fabs(at.Phi_rate[k]));
    }
    report(Item::guide, g, "its line", miss, rate);
  }
  for (int p = 0; p < file.scene.pins; ++p) {
    const Pin& pin = file.scene.pin[p];
    const Point a = point_at(source, pose->kinematics, pin.a, pin.a_at, {true, true});
    const Point b = point_at(source, pose->kinematics, pin.b, pin.b_at, {true, true});
    const Vec2 gap = a.place - b.place, rate = a.velocity - b.velocity;
    report(Item::pin, p, "its point", std::hypot(gap.x, gap.y), std::hypot(rate.x, rate.y));
  }
  return defects;
}

}  // namespace slideway::io
