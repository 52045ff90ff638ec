// The edits that lint tries. Each leaves something out; the remark says what that changed in the steps tried.
#include "lint_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <slideway/structure.hpp>

#include "trial.hpp"

namespace slideway::app {
namespace {

using Scene = slideway::Scene<io::RunSize>;

/// Steps that are tried: seconds for the largest of the shipped scenes.
constexpr int most_steps = 1000;
/// A change of the answer below this is hardly missed: masses and mu are seldom known better.
constexpr double hardly = 1e-3;

/// Moves the origin of a body's frame to a point of it, in all that refers to that frame.
void move_origin(Scene& scene, int body, Vec2 to) {
  const auto move = [&](int of, Vec2& place) {
    if (of == body) place = place - to;
  };
  move(body, scene.body[body].com);
  for (int i = 0; i < scene.bodies; ++i) move(scene.body[i].parent, scene.body[i].at);
  for (int g = 0; g < scene.guides; ++g) {
    Guide& guide = scene.guide[g];
    move(guide.rail, guide.origin);
    for (Vec2& contact : guide.contact) move(guide.slider, contact);
  }
  const auto move_ends = [&](auto& item) {
    move(item.a, item.a_at);
    move(item.b, item.b_at);
  };
  for (int p = 0; p < scene.pins; ++p) move_ends(scene.pin[p]);
  for (int s = 0; s < scene.springs; ++s) move_ends(scene.spring[s]);
  for (int l = 0; l < scene.loads; ++l) move(scene.load[l].body, scene.load[l].at);
}

class Trials {
 public:
  explicit Trials(const io::SceneFile& file) : scene_(file.scene), table_(derive(file.scene)) {
    plan_.method =
        *std::find_if(std::begin(methods), std::end(methods), [&](Method m) { return file.run.method == name(m); });
    plan_.dt = std::fmin(file.run.dt, file.run.duration);
    plan_.steps = static_cast<int>(std::fmin(most_steps, std::round(file.run.duration / plan_.dt)));
    if (scene_.inputs == 0) whole_ = run_trial(scene_, plan_);
    plan_.steps = whole_.steps;
  }

  std::vector<Remark> remarks() && {
    if (plan_.steps == 0) return {};
    try_kinematic();
    for (int i = 0; i < scene_.bodies; ++i) try_without_inertia(i);
    try_points();
    for (int g = 0; g < scene_.guides; ++g) try_without_friction(g);
    for (int p = 0; p < scene_.pins; ++p) try_joint(p);
    return std::move(remarks_);
  }

 private:
  /// A trial of an edited scene that hardly changes the answer, and what it changes in words.
  struct Change {
    Trial trial;
    std::string words;
  };
  std::optional<Change> tried(const Scene& edited, const TrialPlan& plan,
                              const std::vector<int>& without_turn = {}) const {
    if (defects(edited).count > 0) return std::nullopt;
    Change change;
    Apart by;
    for (const int steps : {plan.steps / 20, plan.steps}) {  // most edits show at once what they change
      change.trial = run_trial(edited, {plan.method, plan.dt, steps});
      by = apart(whole_, change.trial, without_turn);
      if (change.trial.steps < steps || !(by.largest() <= hardly)) return std::nullopt;
    }
    change.words = fmt::format("places change by {:.2g} of the scene's length", by.places);
    if (scene_.guides > 0) change.words += fmt::format(", forces of guides by {:.2g} of the largest", by.contacts);
    if (scene_.drives > 0) change.words += fmt::format(", of drives by {:.2g}", by.drives);
    change.words += fmt::format(", in {:g} s", plan.steps * plan.dt);
    return change;
  }

  std::string cost(const Scene& edited, const TrialPlan& plan) const {
    return fmt::format("a step takes {:.2f} of the time", time_ratio(scene_, plan_, edited, plan));
  }

  /// Scenes that their drives move fully.
  void try_kinematic() {
    const bool fully_driven = table_.free > 0 && table_.free == table_.contacts + 2 * scene_.pins;
    if (!fully_driven || plan_.method == Method::kinematic) return;
    TrialPlan plan = plan_;
    plan.method = Method::kinematic;
    const auto change = tried(scene_, plan);
    if (!change) return;
    remarks_.push_back(
        {Item::scene, 0,
         fmt::format(
             "is moved by its drives alone, yet {} integrates it: with method = \"kinematic\" it drifts by {:.2g}, "
             "not {:.2g}, at any dt, from {:.3g} evaluations a step, not {:.3g}, and projections; {}; {}",
             name(plan_.method), change->trial.drift, whole_.drift, change->trial.evaluations, whole_.evaluations,
             change->words, cost(scene_, plan))});
  }

  /// Bodies that drives alone turn: at a constant rate, inertia asks for no moment.
  void try_without_inertia(int i) {
    if (scene_.body[i].inertia == 0 || !table_.turning[i] || table_.freely_turning[i]) return;
    Scene edited = scene_;
    edited.body[i].inertia = 0;
    if (const auto change = tried(edited, plan_))
      remarks_.push_back(
          {Item::body, i, "is turned by drives alone, and its inertia does little: with inertia = 0 " + change->words});
  }

  /// Sliders that turn on the body which carries them, each for the sake of one guide with two contacts: are points
  /// enough? All at once, where several are alike; else one by one.
  void try_points() {
    std::vector<int> guides;
    for (int g = 0; g < scene_.guides; ++g) {
      if (could_be_a_point(g)) guides.push_back(g);
    }
    if (guides.empty() || try_points(guides) || guides.size() == 1) return;
    for (const int g : guides) try_points({g});
  }

  bool try_points(const std::vector<int>& guides) {
    Scene edited = scene_;
    std::vector<int> sliders;
    for (const int g : guides) {
      Guide& guide = edited.guide[g];
      edited.body[guide.slider].joint = Joint::fixed;
      edited.body[guide.slider].inertia = 0;
      guide.contacts = 1;
      guide.contact[0] = {};
      sliders.push_back(guide.slider);
    }
    const auto change = tried(edited, plan_, sliders);
    if (!change) return false;
    const std::size_t more = guides.size() - 1;
    remarks_.push_back(
        {Item::guide, guides[0],
         fmt::format(
             "{}has two contacts where a point would do: with contacts = [[0, 0]] on a slider with joint = "
             "\"fixed\" and inertia = 0, {} coordinates and {} contact forces are solved for, not {} and {}; {}; {}",
             more == 0 ? "" : fmt::format("(and {} more) ", more), derive(edited).free,
             table_.contacts - static_cast<int>(guides.size()), int{table_.free}, int{table_.contacts}, change->words,
             cost(edited, plan_))});
    return true;
  }

  bool could_be_a_point(int g) const {
    const Guide& guide = scene_.guide[g];
    const Body& slider = scene_.body[guide.slider];
    const Vec2 c = guide.contact[0], span = guide.contact[1] - c;
    const bool through_joint =
        std::fabs(cross(c, span)) <= 8 * detail::epsilon * std::sqrt(dot(c, c) * dot(span, span));
    const bool centred = slider.mass == 0 || (slider.com.x == 0 && slider.com.y == 0);
    return guide.contacts == 2 && slider.joint == Joint::revolute && through_joint && centred &&
           serves_only(guide.slider, g);
  }

  bool serves_only(int body, int g) const {
    const auto none_of = [](const auto* items, int count, auto uses) {
      return std::none_of(items, items + count, uses);
    };
    const auto joins = [&](const auto& item) { return item.a == body || item.b == body; };
    const auto acts = [&](const auto& item) { return item.body == body; };
    for (int o = 0; o < scene_.guides; ++o) {
      if (o != g && (scene_.guide[o].slider == body || scene_.guide[o].rail == body)) return false;
    }
    return none_of(scene_.body, scene_.bodies, [&](const Body& b) { return b.parent == body; }) &&
           none_of(scene_.pin, scene_.pins, joins) && none_of(scene_.spring, scene_.springs, joins) &&
           none_of(scene_.drive, scene_.drives, acts) && none_of(scene_.load, scene_.loads, acts) &&
           none_of(scene_.joint_spring, scene_.joint_springs, acts);
  }

  void try_without_friction(int g) {
    const Guide& guide = scene_.guide[g];
    if (!(guide.mu_static > 0)) return;
    Scene edited = scene_;
    edited.guide[g].mu = edited.guide[g].mu_static = 0;
    const auto change = tried(edited, plan_);
    if (!change) return;
    remarks_.push_back({Item::guide, g,
                        fmt::format("has friction that does little, {:.2g} J of {:.2g} J in play: with mu = 0 {}; {}",
                                    whole_.dissipated - change->trial.dissipated, whole_.in_play, change->words,
                                    cost(edited, plan_))});
  }

  /// A pin that holds a planar body to an earlier one, or to the ground: a revolute joint says it in one coordinate.
  void try_joint(int p) {
    const Pin& pin = scene_.pin[p];
    const bool a_is_later = pin.a > pin.b;
    const int body = a_is_later ? pin.a : pin.b, other = a_is_later ? pin.b : pin.a;
    const Body& planar = scene_.body[body];
    const bool is_driven =
        std::any_of(scene_.drive, scene_.drive + scene_.drives, [&](const Drive& drive) { return drive.body == body; });
    if (planar.joint != Joint::planar || is_driven) return;
    Scene edited = scene_;
    move_origin(edited, body, a_is_later ? pin.a_at : pin.b_at);
    Body& turning = edited.body[body];
    turning.joint = Joint::revolute;
    turning.parent = other;
    turning.at = a_is_later ? pin.b_at : pin.a_at;
    turning.angle = 0;
    turning.turn = {1, 0};
    const Turning of_body = turning_of(body), of_other = turning_of(other);
    turning.q[0] = of_body.angle - of_other.angle;
    turning.v[0] = of_body.rate - of_other.rate;
    std::copy(edited.pin + p + 1, edited.pin + edited.pins, edited.pin + p);
    --edited.pins;
    if (const auto change = tried(edited, plan_)) {
      remarks_.push_back(
          {Item::pin, p,
           fmt::format("holds a planar body that could turn on a revolute joint there, with two coordinates "
                       "and two constraints less; {}; {}",
                       change->words, cost(edited, plan_))});
    }
  }

  struct Turning {
    double angle = 0, rate = 0;
  };
  /// At the start.
  Turning turning_of(int i) const {
    Turning sum;
    for (int body = i; body != ground; body = scene_.body[body].parent) {
      const Body& b = scene_.body[body];
      const int k = b.joint == Joint::planar ? 2 : 0;
      const bool turns = b.joint == Joint::planar || b.joint == Joint::revolute;
      sum.angle += b.angle + (turns ? b.q[k] : 0);
      sum.rate += turns ? b.v[k] : 0;
    }
    return sum;
  }

  const Scene& scene_;
  Tables<io::RunSize> table_;
  TrialPlan plan_;
  Trial whole_;
  std::vector<Remark> remarks_;
};

}  // namespace

std::vector<Remark> remarks_by_trial(const io::SceneFile& file, const std::vector<Remark>& known) {
  std::vector<Remark> remarks = Trials(file).remarks();
  std::erase_if(remarks, [&](const Remark& one) {
    return std::any_of(known.begin(), known.end(),
                       [&](const Remark& other) { return other.item == one.item && other.index == one.index; });
  });
  return remarks;
}

}  // namespace slideway::app
