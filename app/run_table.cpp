#include "run_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <slideway/method.hpp>

namespace slideway::app {
namespace {

class Table {
 public:
  template <class... Values>
  void row(std::string_view title, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), "{:<18}{}\n", title,
                   fmt::format(format, std::forward<Values>(values)...));
  }
  void gap() { text_ += '\n'; }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

std::string counted(int count, const char* one) { return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s"); }

std::string contents(const io::SceneFile& file) {
  const auto& scene = file.scene;
  std::string list = counted(scene.bodies, "body");
  if (scene.bodies > 1) list = fmt::format("{} bodies", scene.bodies);
  const auto add = [&](int count, const char* one) {
    if (count > 0) list += ", " + counted(count, one);
  };
  add(coordinates(scene), "coordinate");
  add(scene.guides, "guide");
  add(contacts(scene), "contact");
  add(scene.drives, "drive");
  add(scene.pins, "pin");
  add(scene.springs + scene.joint_springs, "spring");
  add(scene.loads, "load");
  return list;
}

void add_peaks(Table& table, const char* kind, const std::vector<std::string>& names, const std::vector<Peak>& peaks,
               const std::vector<const char*>& units) {
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    table.row(fmt::format("  {} {}", kind, names[i]), "{:12.6g} {:<3} at {:.6g} s", peaks[i].value, units[i],
              peaks[i].t);
  }
}

std::vector<const char*> drive_units(const io::SceneFile& file) {
  std::vector<const char*> units;
  for (std::size_t d = 0; d < file.drive_names.size(); ++d) {
    const Drive& drive = file.scene.drive[d];
    const Joint joint = file.scene.body[drive.body].joint;
    units.push_back(joint == Joint::revolute || drive.axis == 2 ? "N m" : "N");
  }
  return units;
}

void add_all_peaks(Table& table, const Recording& recording) {
  const io::SceneFile& file = recording.file;
  std::vector<std::string> contact_names;
  for (std::size_t g = 0; g < file.guide_names.size(); ++g) {
    for (int k = 0; k < file.scene.guide[g].contacts; ++k) {
      contact_names.push_back(fmt::format("{}.{}", file.guide_names[g], k));
    }
  }
  const auto newtons = [](const std::vector<Peak>& peaks) { return std::vector<const char*>(peaks.size(), "N"); };
  table.gap();
  table.row("peaks", "");
  add_peaks(table, "contact", contact_names, recording.lambda_peak, newtons(recording.lambda_peak));
  add_peaks(table, "friction", file.guide_names, recording.friction_peak, newtons(recording.friction_peak));
  add_peaks(table, "drive", file.drive_names, recording.drive_peak, drive_units(file));
  add_peaks(table, "pin", file.pin_names, recording.pin_peak, newtons(recording.pin_peak));
}

std::string kinds(const std::vector<Event>& events) {
  std::string list;
  for (const EventKind kind :
       {EventKind::slip_reversal, EventKind::stick, EventKind::slip, EventKind::normal_reversal}) {
    const auto count = std::count_if(events.begin(), events.end(), [=](const Event& e) { return e.kind == kind; });
    if (count > 0) list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, name(kind));
  }
  return list;
}

void add_events(Table& table, const Recording& recording) {
  constexpr std::size_t most = 10;
  const std::vector<Event>& events = recording.events;
  if (events.empty()) return;
  const long long all = static_cast<long long>(events.size()) + recording.events_left_out;
  const std::size_t listed = std::min(most, events.size());
  table.gap();
  table.row("events", "{:>12} {}: {}{}", all, recording.located ? "located" : "seen after a step",
            recording.events_left_out > 0 ? fmt::format("of the first {}, ", events.size()) : "", kinds(events));
  for (std::size_t i = 0; i < listed; ++i) {
    const Event& event = events[i];
    const std::string& guide = recording.file.guide_names[static_cast<std::size_t>(event.guide)];
    table.row("", "{:12.9g} s   {}{} {}", event.t, guide,
              event.contact == none ? "" : fmt::format(".{}", event.contact), name(event.kind));
  }
  const long long more = all - static_cast<long long>(listed);
  if (more > 0) table.row("", "{:>12} more", more);
}

/// With what else the method depends on.
std::string method(const Recording& recording) {
  std::string text = recording.method;
  if (recording.method == name(Method::moreau)) text += fmt::format(", theta {:g}", recording.theta);
  if (recording.stabilise != "baumgarte") text += ", " + recording.stabilise;
  return text;
}

void add_energies(Table& table, const Recording& recording) {
  const double miss = recording.energy_miss();
  table.gap();
  table.row("energy", "{:12.6g} J   at the start", recording.energy_initial);
  table.row("", "{:12.6g} J   at the end", recording.energy_final);
  table.row("  work", "{:12.6g} J   by drives and loads", recording.energy.work);
  table.row("  dissipated", "{:12.6g} J   by friction and dampers", recording.energy.dissipated);
  table.row("  constraint work", "{:12.6g} J", recording.energy.constraint_work);
  table.row("  miss", "{:12.3g} J   {:.2g} of the {:.6g} J in play", miss,
            recording.energy_in_play > 0 ? std::abs(miss) / recording.energy_in_play : 0.0, recording.energy_in_play);
}

}  // namespace

std::string run_table(const Recording& recording, const std::vector<const Output*>& outputs) {
  const io::SceneFile& file = recording.file;
  Table table;
  table.row("scene", "{}: {}", file.name, contents(file));
  for (const std::string& setting : file.settings) table.row("", "--set {}", setting);
  table.row("ran", "{}, dt {:g} s, {} steps to t = {:.9g} s", method(recording), recording.dt, recording.steps,
            recording.t);
  table.row("status", "{}", name(recording.status));
  table.gap();
  table.row("largest drift", "{:12.3g} m or rad, {:.3g} a second", recording.drift_position, recording.drift_velocity);
  table.row("largest residual", "{:12.3g} summed over the equations, each in its terms' size", recording.residual);
  table.row("most solves", "{:>12} for one set of contact forces", recording.solves_max);
  table.row("uniqueness", "{:>12}", name(recording.uniqueness));
  table.row("unlocated events", "{:>12}", recording.unlocated_events);
  if (!recording.lambda_peak.empty() || !recording.drive_peak.empty() || !recording.pin_peak.empty()) {
    add_all_peaks(table, recording);
  }
  add_energies(table, recording);
  add_events(table, recording);
  table.gap();
  table.row("time", "{:12.4g} ns a step", recording.ns_per_step);
  for (const Output* output : outputs) {
    if (output->wanted() && !output->standard()) table.row("wrote", "{}", output->file());
  }
  return std::move(table).text();
}

}  // namespace slideway::app
