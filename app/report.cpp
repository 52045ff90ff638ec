#include "report.hpp"

#include <cmath>
#include <string>

#include "page.hpp"

namespace slideway::app {
namespace {

using io::Json;

/// To nine significant digits, a thousand times finer than any screen shows; the CSV has all of them.
Json number(double x) { return rounded(x, 9); }

Json point(Vec2 r) { return {number(r.x), number(r.y)}; }

template <class Value>
Json column(const std::vector<Sample>& samples, Value value) {
  Json result = Json::array();
  for (const Sample& sample : samples) result.push_back(number(value(sample)));
  return result;
}

/// Sample by sample -> column by column.
template <class Value>
Json columns(const std::vector<Sample>& samples, int count, Value value) {
  Json result = Json::array();
  for (int j = 0; j < count; ++j) result.push_back(column(samples, [&](const Sample& s) { return value(s, j); }));
  return result;
}

const char* name(Joint joint) {
  switch (joint) {
    case Joint::revolute:
      return "revolute";
    case Joint::prismatic:
      return "prismatic";
    case Joint::planar:
      return "planar";
    case Joint::fixed:
      return "fixed";
  }
  return "unknown";
}

Json bodies(const io::SceneFile& file) {
  Json result = Json::array();
  for (int i = 0; i < file.scene.bodies; ++i) {
    const Body& body = file.scene.body[i];
    Json start = Json::array();
    for (int j = 0; j < coordinates(body.joint); ++j) start.push_back(number(body.q[j]));
    result.push_back({{"name", file.body_names.at(i)},
                      {"parent", body.parent},
                      {"joint", name(body.joint)},
                      {"at", point(body.at)},
                      {"angle", number(body.angle)},
                      {"mass", number(body.mass)},
                      {"com", point(body.com)},
                      {"start", start}});
  }
  return result;
}

Json guides(const io::SceneFile& file) {
  Json result = Json::array();
  for (int g = 0; g < file.scene.guides; ++g) {
    const Guide& guide = file.scene.guide[g];
    Json contacts = Json::array();
    for (int k = 0; k < guide.contacts; ++k) contacts.push_back(point(guide.contact[k]));
    result.push_back({{"name", file.guide_names.at(g)},
                      {"slider", guide.slider},
                      {"rail", guide.rail},
                      {"origin", point(guide.origin)},
                      {"tangent", point(guide.tangent)},
                      {"contacts", contacts}});
  }
  return result;
}

Json drives(const io::SceneFile& file) {
  Json result = Json::array();
  for (int d = 0; d < file.scene.drives; ++d) {
    const Drive& drive = file.scene.drive[d];
    const Joint joint = file.scene.body[drive.body].joint;
    const bool turns = joint == Joint::revolute || (joint == Joint::planar && drive.axis == 2);
    result.push_back(
        {{"name", file.drive_names.at(d)}, {"body", drive.body}, {"axis", drive.axis}, {"unit", turns ? "N m" : "N"}});
  }
  return result;
}

/// Pins and springs: two points, each on a body.
template <class Link>
Json links(const Link* link, int count, const std::vector<std::string>& names) {
  Json result = Json::array();
  for (int i = 0; i < count; ++i) {
    result.push_back({{"name", names.at(i)},
                      {"a", link[i].a},
                      {"a_at", point(link[i].a_at)},
                      {"b", link[i].b},
                      {"b_at", point(link[i].b_at)}});
  }
  return result;
}

Json loads(const Recording& recording) {
  const io::SceneFile& file = recording.file;
  Json result = Json::array();
  for (int l = 0; l < file.scene.loads; ++l) {
    const Load& load = file.scene.load[l];
    const double scale = load.input == none ? 1 : recording.input_values.at(load.input);
    result.push_back({{"name", file.load_names.at(l)},
                      {"body", load.body},
                      {"at", point(load.at)},
                      {"force", point({scale * load.force.x, scale * load.force.y})},
                      {"torque", number(scale * load.torque)}});
  }
  return result;
}

Json inputs(const Recording& recording) {
  Json result = Json::array();
  for (std::size_t i = 0; i < recording.file.input_names.size(); ++i) {
    result.push_back({recording.file.input_names[i], number(recording.input_values.at(i))});
  }
  return result;
}

Json scene(const Recording& recording) {
  const io::SceneFile& file = recording.file;
  Json joint_springs = Json::array();
  for (int s = 0; s < file.scene.joint_springs; ++s)
    joint_springs.push_back({{"body", file.scene.joint_spring[s].body}});
  return {{"name", file.name},
          {"hash", file.hash},
          {"settings", file.settings},
          {"gravity", point(file.scene.gravity)},
          {"alpha", number(recording.alpha)},
          {"beta", number(recording.beta)},
          {"bodies", bodies(file)},
          {"guides", guides(file)},
          {"drives", drives(file)},
          {"pins", links(file.scene.pin, file.scene.pins, file.pin_names)},
          {"springs", links(file.scene.spring, file.scene.springs, file.spring_names)},
          {"joint_springs", joint_springs},
          {"loads", loads(recording)}};
}

Json run(const Recording& recording) {
  return {{"method", recording.method},
          {"dt", number(recording.dt)},
          {"duration", number(recording.duration)},
          {"located", recording.located},
          {"stabilise", recording.stabilise},
          {"theta", number(recording.theta)},
          {"steps", recording.steps},
          {"t", number(recording.t)},
          {"status", slideway::name(recording.status)},
          {"message", recording.status == Status::ok || recording.message.empty() ? sentence(recording.status)
                                                                                  : recording.message},
          {"uniqueness", slideway::name(recording.uniqueness)},
          {"drift_position", number(recording.drift_position)},
          {"drift_velocity", number(recording.drift_velocity)},
          {"residual", number(recording.residual)},
          {"solves_max", recording.solves_max},
          {"unlocated_events", recording.unlocated_events},
          {"events_left_out", recording.events_left_out},
          {"ns_per_step", number(recording.ns_per_step)}};
}

Json peaks(const std::vector<Peak>& peaks) {
  Json result = Json::array();
  for (const Peak& peak : peaks) result.push_back({number(peak.value), number(peak.t)});
  return result;
}

/// The miss is a difference of nearly equal numbers: taken here, before they are shortened.
double energy_miss(const Sample& sample, double initial) {
  return sample.energy - initial - (sample.work - sample.dissipated + sample.constraint_work);
}

Json energy(const Recording& recording) {
  return {{"initial", number(recording.energy_initial)},
          {"final", number(recording.energy_final)},
          {"work", number(recording.energy.work)},
          {"dissipated", number(recording.energy.dissipated)},
          {"constraint_work", number(recording.energy.constraint_work)},
          {"miss", number(recording.energy_miss())},
          {"in_play", number(recording.energy_in_play)}};
}

Json samples(const Recording& recording) {
  const std::vector<Sample>& all = recording.samples;
  const auto& scene = recording.file.scene;
  const double initial = recording.energy_initial;
  return {{"t", column(all, [](const Sample& s) { return s.t; })},
          {"q", columns(all, coordinates(scene), [](const Sample& s, int j) { return s.q[j]; })},
          {"slip", columns(all, scene.guides, [](const Sample& s, int g) { return s.slip[g]; })},
          {"lambda", columns(all, contacts(scene), [](const Sample& s, int c) { return s.lambda[c]; })},
          {"friction", columns(all, scene.guides, [](const Sample& s, int g) { return s.friction[g]; })},
          {"drive", columns(all, scene.drives, [](const Sample& s, int d) { return s.drive[d]; })},
          {"pin", columns(all, scene.pins, [](const Sample& s, int p) { return std::hypot(s.pin[p].x, s.pin[p].y); })},
          {"energy", column(all, [=](const Sample& s) { return s.energy - initial; })},
          {"work", column(all, [](const Sample& s) { return s.work; })},
          {"dissipated", column(all, [](const Sample& s) { return s.dissipated; })},
          {"constraint_work", column(all, [](const Sample& s) { return s.constraint_work; })},
          {"miss", column(all, [=](const Sample& s) { return energy_miss(s, initial); })},
          {"drift", column(all, [](const Sample& s) { return s.drift; })}};
}

Json events(const Recording& recording) {
  Json result = Json::array();
  for (const Event& event : recording.events) result.push_back({number(event.t), event.guide, name(event.kind)});
  return result;
}

/// By guide: [time, the mode from then on].
Json modes(const Recording& recording) {
  Json result = Json::array();
  for (const std::vector<ModeSpan>& spans : recording.modes) {
    Json list = Json::array();
    for (const ModeSpan& span : spans) list.push_back({number(span.t), span.mode});
    result.push_back(std::move(list));
  }
  return result;
}

/// [time, the weakest statement from then on]; it changes at samples.
Json uniqueness(const Recording& recording) {
  Json result = Json::array();
  if (recording.samples.empty()) return result;
  Uniqueness last = recording.weakest.front();
  result.push_back({number(recording.samples.front().t), name(last)});
  for (std::size_t i = 1; i < recording.samples.size(); ++i) {
    if (recording.weakest[i] == last) continue;
    last = recording.weakest[i];
    result.push_back({number(recording.samples[i - 1].t), name(last)});
  }
  return result;
}

Json data(const Recording& recording) {
  return {
      {"version", SLIDEWAY_VERSION},
      {"scene", scene(recording)},
      {"inputs", inputs(recording)},
      {"run", run(recording)},
      {"peaks",
       {{"lambda", peaks(recording.lambda_peak)},
        {"friction", peaks(recording.friction_peak)},
        {"drive", peaks(recording.drive_peak)},
        {"pin", peaks(recording.pin_peak)}}},
      {"energy", energy(recording)},
      {"events", events(recording)},
      {"modes", modes(recording)},
      {"uniqueness", uniqueness(recording)},
      {"samples", samples(recording)},
  };
}

}  // namespace

void write_report(const Recording& recording, std::ostream& out) {
  write_page("report.html", recording.file.name, data(recording), out);
}

}  // namespace slideway::app
