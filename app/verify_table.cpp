#include "verify_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace slideway::app {
namespace {

std::string line(const Check& check) {
  const char* verdict = check.held() ? "" : "   FAILS";
  if (check.counts()) {
    return fmt::format("  {:<24}{:>7.0f}  {}{}\n", check.quantity, check.error, check.unit,
                       check.held() ? "" : fmt::format("{}, first at t = {:.6g} s", verdict, check.t));
  }
  return fmt::format("  {:<24}{:>7.1f}{:>9.1f}{:>12.2e}{:>12.2e}  {}{}\n", check.quantity, check.digits(),
                     check.digits_needed(), check.error, check.bound, check.unit,
                     check.held() ? "" : fmt::format("{} at t = {:.6g} s", verdict, check.t));
}

io::Json document_of(const Check& check) {
  io::Json json{{"quantity", check.quantity}, {"unit", check.unit}, {"error", check.error}, {"bound", check.bound}};
  if (!check.counts()) {
    json["scale"] = check.scale;
    json["digits"] = check.digits();
    json["digits_needed"] = check.digits_needed();
  }
  json["t"] = check.t;
  json["held"] = check.held();
  return json;
}

}  // namespace

std::string verify_table(const Verification& verification) {
  const Recording& run = verification.run.recording;
  std::string text =
      fmt::format("{}: {}, dt {:g} s, {} steps to t = {:g} s\n", run.file.name, run.method, run.dt, run.steps, run.t);
  text +=
      fmt::format("oracle: {} steps, {} events, {:.0f} digits shared by two runs of different order and step\n",
                  verification.reference_steps, verification.reference_events.size(), verification.reference_digits);
  if (!verification.reference_end.empty())
    text += fmt::format("the oracle's trajectory {}\n", verification.reference_end);
  for (const CheckGroup& group : verification.groups) {
    if (group.checks.empty()) continue;
    text += fmt::format("\n{}: {}\n  {:<24}{:>7}{:>9}{:>12}{:>12}\n", group.title, group.explanation, "", "digits",
                        "needed", "error", "bound");
    for (const Check& check : group.checks) text += line(check);
  }
  for (std::size_t i = 0; i < verification.not_checked.size(); ++i) {
    text += fmt::format("{}{}\n", i == 0 ? "\nnot checked: " : "             ", verification.not_checked[i]);
  }
  return text + fmt::format("\n{}\n", verification.held() ? "verified" : "NOT VERIFIED");
}

io::Json verify_document(const Verification& verification) {
  const Recording& run = verification.run.recording;
  io::Json json = io::document(run.file);
  json.update({{"method", run.method},
               {"dt", run.dt},
               {"steps", run.steps},
               {"status", name(run.status)},
               {"t", run.t},
               {"message", run.message},
               {"verified", verification.held()}});
  io::Json events = io::Json::array();
  for (const Event& event : verification.reference_events) {
    events.push_back({{"t", event.t},
                      {"guide", run.file.guide_names[static_cast<std::size_t>(event.guide)]},
                      {"contact", event.contact == none ? io::Json() : io::Json(event.contact)},
                      {"kind", name(event.kind)}});
  }
  json["oracle"] = {{"steps", verification.reference_steps},
                    {"digits", verification.reference_digits},
                    {"events", events},
                    {"end", verification.reference_end}};
  io::Json groups = io::Json::array();
  for (const CheckGroup& group : verification.groups) {
    io::Json checks = io::Json::array();
    for (const Check& check : group.checks) checks.push_back(document_of(check));
    groups.push_back({{"title", group.title}, {"explanation", group.explanation}, {"checks", checks}});
  }
  json["groups"] = groups;
  json["not_checked"] = verification.not_checked;
  return json;
}

}  // namespace slideway::app
