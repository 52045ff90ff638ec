// Step size against the time that is left until friction makes the contacts' matrix singular, where no event is. In
// one scene the force grows without bound and there is no answer beyond (a pole); in the other a second answer comes in
// from infinity. One step from each distance. If it ends before that, it is held against dop853_located with an eighth
// of it. If not, it should be refused; at the latest, forces should be where it ends.
#include <cmath>

#include "exact_instant.hpp"
#include "short_run.hpp"

namespace slideway::charts {
namespace {

constexpr double first = 1e-4;  // s, of both axes

/// The mechanism at a time: its drive decides the pose. False where none is found.
bool place(const io::RunStepper& stepper, double t, State& state) {
  state = stepper.start();
  state.start = t;
  return stepper.project(state).status == Status::ok;
}

bool is_unique(const io::RunStepper& stepper, double t) {
  State state;
  return place(stepper, t, state) && ExactInstant(stepper.source.scene, state).is_unique();
}

/// When there is not one answer any more, between a time when there is and one when there is not.
double find_end(const io::RunStepper& stepper, double low, double high) {
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (is_unique(stepper, middle) ? low : high) = middle;
  }
  return high;
}

/// A step that was made over the end. Where the answer goes on beside a second one, it may be that which the step
/// follows: as one that is told to continue with the signs it has, in eighths.
Cell judge_beyond(io::RunStepper stepper, const State& from, double dt, const ShortRun& made) {
  io::RunStepper::Reaction r;
  if (stepper.reaction(made.state, {}, r).status != Status::ok) return Cell::refused_late;
  stepper.hlcp.not_unique = NotUnique::continue_along_signs;
  io::RunStepper judge = stepper;
  judge.method = Method::dop853_located;
  const ShortRun truth = short_run(judge, from, dt / 8, 8);
  if (truth.status == Status::ok && keeps_its_promise(stepper, from, dt, made)) return Cell::right;
  return made.unlocated > 0 ? Cell::warned : Cell::wrong;
}

struct Approach {
  std::string name, title;
  RunScene scene;
  double low, high;  ///< s: one answer, and not
};

void draw(const Approach& approach, const AtlasOptions& options, AtlasMap& map) {
  io::RunStepper stepper(approach.scene);
  const double end = find_end(stepper, approach.low, approach.high);
  const double largest = 0.29;
  const Grid grid{{"step, s", first, 10, true},
                  {"time left, s", first, largest, true},
                  options.quick ? 15 : 60,
                  options.quick ? 12 : 40};
  for (const Method method : methods) {
    stepper.method = method;
    const auto cells = judge_cells(grid, [&](double dt, double left) {
      State from;
      if (!place(stepper, end - left, from)) return Cell::refused_wrongly;
      const ShortRun run = short_run(stepper, from, dt, 1);
      if (run.status != Status::ok) return dt > left ? Cell::refused_rightly : Cell::refused_wrongly;
      if (dt > left) return judge_beyond(stepper, from, dt, run);
      if (keeps_its_promise(stepper, from, dt, run)) return Cell::right;
      return run.unlocated > 0 ? Cell::warned : Cell::wrong;
    });
    const std::string who = slideway::name(method);
    const Line line{"the step ends there", {6, -1, false}, {{first, first}, {largest, largest}}, {}};
    add_cells(map, {approach.name + "_" + who, "slideway " + who, approach.title, {line}, {}}, grid, cells);
  }
  map.document[approach.name + "_at"] = end;
}

}  // namespace

AtlasMap draw_pole(const AtlasOptions& options) {
  AtlasMap map = begin_map("pole");
  RunScene scene = options.scene("slider_crank_equal");
  draw({"second", "One step towards a second answer", scene, 0.28, 0.32}, options, map);
  scene.gravity.y = -scene.gravity.y;
  draw({"none", "One step towards a pole of the contact force", scene, 0.28, 0.32}, options, map);
  return map;
}

}  // namespace slideway::charts
