#include "run_document.hpp"

namespace slideway::app {

using io::Json;

namespace {

Json events(const Recording& recording) {
  Json list = Json::array();
  for (const Event& event : recording.events) {
    list.push_back({{"t", event.t},
                    {"guide", recording.file.guide_names[static_cast<std::size_t>(event.guide)]},
                    {"contact", event.contact == none ? Json(nullptr) : Json(event.contact)},
                    {"kind", name(event.kind)}});
  }
  return list;
}

Json reactions(const io::SceneFile& file, const Sample& last) {
  return {{"lambda", io::by_contact(file, last.lambda)},
          {"friction", io::by_name(file.guide_names, last.friction)},
          {"drive", io::by_name(file.drive_names, last.drive)},
          {"pin", io::by_name(file.pin_names, last.pin)}};
}

}  // namespace

Json run_document(const Recording& recording) {
  const io::SceneFile& file = recording.file;
  Json json = io::document(file);
  json["method"] = recording.method;
  json["dt"] = recording.dt;
  json["alpha"] = recording.alpha;
  json["beta"] = recording.beta;
  json["stabilise"] = recording.stabilise;
  json["theta"] = recording.theta;
  json["inputs"] = io::by_name(file.input_names, recording.input_values);
  json["steps"] = recording.steps;
  json["status"] = name(recording.status);
  json["t"] = recording.t;
  json["message"] = recording.message;
  json["drift_position"] = recording.drift_position;
  json["drift_velocity"] = recording.drift_velocity;
  json["residual"] = recording.residual;
  json["solves_max"] = recording.solves_max;
  json["uniqueness"] = name(recording.uniqueness);
  json["ns_per_step"] = recording.ns_per_step;
  json["unlocated_events"] = recording.unlocated_events;
  json["events"] = events(recording);
  json["events_left_out"] = recording.events_left_out;
  json["energy"] = {{"initial", recording.energy_initial},
                    {"final", recording.energy_final},
                    {"work", recording.energy.work},
                    {"dissipated", recording.energy.dissipated},
                    {"constraint_work", recording.energy.constraint_work},
                    {"in_play", recording.energy_in_play}};
  const Sample& last = recording.samples.back();
  json["final"] = {{"q", io::by_body(file, last.q)}, {"v", io::by_body(file, last.v)}};
  json["reactions"] = reactions(file, last);
  return json;
}

}  // namespace slideway::app
