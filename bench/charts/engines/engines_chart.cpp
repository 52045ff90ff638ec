#include "engines_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <slideway/scenes/crank_rocker_offset.hpp>

#include "motion/kernel_contender.hpp"

namespace slideway::charts {
namespace {

constexpr auto without_friction(auto scene) {
  for (Guide& guide : scene.guide) guide.mu = guide.mu_static = 0;
  return scene;
}
constexpr auto frictionless = without_friction(crank_rocker_offset);

io::RunStepper exact_stepper(const RunScene& scene) {
  io::RunStepper stepper(scene);
  stepper.method = Method::dop853_located;
  stepper.stabilise = Stabilise::projection;
  return stepper;
}

/// States after each interval, by so many steps in each.
std::vector<io::RunStepper::State> fine_run(const RunScene& scene, double duration, int steps) {
  const io::RunStepper stepper = exact_stepper(scene);
  std::vector<io::RunStepper::State> states{stepper.start()};
  const double dt = duration / oracle::reference_intervals / steps;
  for (int k = 0; k < oracle::reference_intervals; ++k) {
    io::RunStepper::State state = states.back();
    for (int i = 0; i < steps; ++i) {
      const Report report = stepper.step(state, dt);
      if (report.status != Status::ok) throw std::runtime_error(slideway::name(report.status));
    }
    states.push_back(state);
  }
  return states;
}

/// The constant sum of contact forces whose friction does as much work in the exact run, N.
double even_force(const RunScene& scene, double duration) {
  constexpr int samples = 2000;
  const io::RunStepper stepper = exact_stepper(scene);
  io::RunStepper::State state = stepper.start();
  double work = 0, path = 0;
  for (int k = 0; k < samples; ++k) {
    io::RunStepper::Reaction r;
    if (stepper.reaction(state, {}, r).status != Status::ok ||
        stepper.step(state, duration / samples).status != Status::ok) {
      throw std::runtime_error("no mean of the contact forces");
    }
    for (int c = 0; c < stepper.source.tables.contacts; ++c) work += std::fabs(r.lambda[c] * r.slip[0]);
    path += std::fabs(r.slip[0]);
  }
  return work / path;
}

/// A fine run as a reference; a coarser one tells how many digits it has.
oracle::Reference fine_reference(const RunScene& scene, double duration) {
  const auto fine = fine_run(scene, duration, 200), coarser = fine_run(scene, duration, 150);
  const io::RunStepper stepper = exact_stepper(scene);
  oracle::Reference reference;
  reference.duration = duration;
  double apart = 0, size = 0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    io::RunStepper::Reaction r;
    if (stepper.reaction(fine[k], {}, r).status != Status::ok) throw std::runtime_error("no reaction");
    auto& sample = reference.trajectory.samples.emplace_back();
    sample.t = duration * static_cast<double>(k) / oracle::reference_intervals;
    for (int j = 0; j < stepper.source.tables.coordinates; ++j) {
      sample.q.emplace_back(fine[k].q[j]);
      apart = std::max(apart, std::fabs(fine[k].q[j] - coarser[k].q[j]));
      size = std::max(size, std::fabs(fine[k].q[j]));
    }
    for (int c = 0; c < stepper.source.tables.contacts; ++c) sample.lambda.emplace_back(r.lambda[c]);
  }
  reference.digits = apart > 0 ? -std::log10(apart / size) : 15;
  return reference;
}

bool is_of(const Contender& contender, const Engine& engine) { return contender.family.starts_with(engine.name); }

/// ns of a step, where steps are of one length; else 0.
double ns_of_step(const Measured& m) {
  const std::string& setting = m.contender->setting;
  return setting == "dt" || setting == "step" ? m.ns * m.setting : 0;
}

template <class Among>
const Measured* cheapest_step(const EngineComparison& comparison, const Among& among) {
  const Measured* best = nullptr;
  for (const Measured& m : comparison.measured.measured) {
    if (!m.failure.empty() || m.ns_low == 0 || ns_of_step(m) == 0 || !among(m)) continue;
    if (best == nullptr || ns_of_step(m) < ns_of_step(*best)) best = &m;
  }
  return best;
}

io::Json json_of_step(const Measured& m) {
  return {{"family", m.contender->family},
          {"name", m.contender->name},
          {"step", m.setting},
          {"ns_of_step", ns_of_step(m)},
          {"error", m.error}};
}

io::Json json_of(const EngineComparison& comparison) {
  io::Json json = document(comparison.measured);
  json.erase("cheapest");
  json["mu"] = comparison.scene->guide[0].mu;
  json["even_contact_force"] = comparison.mechanism->even_force;
  for (auto& point : json["measured"]) {  // engines are not asked for contact forces
    if (point.contains("force_error") && !point.contains("dt")) point.erase("force_error");
  }
  io::Json steps = io::Json::array();
  for (const Engine& engine : engines()) {
    for (const StepRatio& ratio : step_ratios(comparison, engine)) {
      steps.push_back({{"engine", engine.name},
                       {"step", json_of_step(*ratio.engine)},
                       {"least_error", ratio.least_error},
                       {"kernel", json_of_step(*ratio.kernel)},
                       {"times_dearer", ratio.ratio()}});
    }
  }
  json["steps"] = std::move(steps);
  return json;
}

}  // namespace

std::vector<Engine> engines() { return {mujoco_engine(), ode_engine(), simbody_engine()}; }

EngineComparison compare_engines(const io::SceneFile& scene, const oracle::Reference& reference, bool frictional,
                                 const MeasureOptions& options) {
  const double interval = reference.duration / oracle::reference_intervals;
  EngineComparison comparison{std::make_unique<RunScene>(scene.scene), nullptr, {scene, reference, {}, {}}};
  if (!frictional) {
    *comparison.scene = without_friction(scene.scene);
    comparison.measured.scene.scene = *comparison.scene;
    comparison.measured.reference = fine_reference(*comparison.scene, reference.duration);
  }
  comparison.mechanism = std::make_unique<CrankMechanism>(
      crank_mechanism(*comparison.scene, even_force(*comparison.scene, reference.duration), interval));
  Contenders& contenders = comparison.measured.contenders;
  if (frictional) {
    add_methods(Stepper<crank_rocker_offset>{}, interval, "", contenders);
  } else {
    add_methods(Stepper<frictionless>{}, interval, "", contenders);
  }
  for (const Engine& engine : engines()) {
    for (const EngineFriction friction : frictional ? engine.frictions : std::vector{EngineFriction::none}) {
      engine.add(*comparison.mechanism, friction, contenders);
    }
  }
  comparison.measured.measured = measure(contenders, comparison.measured.reference, options);
  return comparison;
}

Chart engines_chart(const EngineComparison& comparison) {
  const bool frictional = comparison.scene->guide[0].mu > 0;
  Chart chart = time_chart(comparison.measured);
  chart.title = frictional ? "General engines on the crank-rocker" : "General engines on the crank-rocker, mu = 0";
  std::string missing;
  int colour = 5;
  for (const Engine& engine : engines()) {
    if (engine.version.empty()) missing += (missing.empty() ? "; missing: " : ", ") + engine.name;
    int marker = 0;
    for (Line& line : chart.lines) {
      if (!line.name.starts_with(engine.name)) continue;
      line.style = {colour, marker, true};
      marker += 2;
    }
    ++colour;
  }
  chart.subtitle += missing;
  if (frictional) {  // where no line is: dearer than the kernel, more accurate than engines
    const double x = chart.x.from * std::pow(chart.x.to / chart.x.from, 0.52);
    double y = 1e-8;
    chart.notes.push_back({{x, y}, "No joint is braked by its own force."});
    for (const Engine& engine : engines()) {
      if (!engine.version.empty()) chart.notes.push_back({{x, y /= 10}, engine.in_short});
    }
  }
  return chart;
}

double StepRatio::engine_ns() const { return ns_of_step(*engine); }
double StepRatio::kernel_ns() const { return ns_of_step(*kernel); }

std::vector<StepRatio> step_ratios(const EngineComparison& comparison, const Engine& engine) {
  std::vector<StepRatio> ratios;
  for (const auto& contender : comparison.measured.contenders) {
    if (!is_of(*contender, engine)) continue;
    StepRatio ratio{cheapest_step(comparison, [&](const Measured& m) { return m.contender == contender.get(); }),
                    nullptr, HUGE_VAL};
    for (const Measured& m : comparison.measured.measured) {
      if (m.failure.empty() && m.contender == contender.get()) ratio.least_error = std::min(ratio.least_error, m.error);
    }
    ratio.kernel = cheapest_step(
        comparison, [&](const Measured& m) { return is_kernel(*m.contender) && m.error < ratio.least_error; });
    if (ratio.engine != nullptr && ratio.kernel != nullptr) ratios.push_back(ratio);
  }
  return ratios;
}

const StepRatio* least_ratio(const std::vector<StepRatio>& ratios) {
  const auto least = std::min_element(ratios.begin(), ratios.end(),
                                      [](const StepRatio& a, const StepRatio& b) { return a.ratio() < b.ratio(); });
  return least == ratios.end() ? nullptr : &*least;
}

io::Json document(const EngineComparison& with_friction, const EngineComparison& without) {
  io::Json all = io::Json::array();
  for (const Engine& engine : engines()) {
    io::Json families = io::Json::array();
    for (const EngineFriction friction : engine.frictions) families.push_back(family_of(engine.name, friction));
    all.push_back({{"name", engine.name},
                   {"version", engine.version.empty() ? "missing" : engine.version},
                   {"cannot_express", engine.cannot},
                   {"families", std::move(families)}});
  }
  return {{"format", io::json_format},
          {"engines", std::move(all)},
          {"friction", json_of(with_friction)},
          {"no_friction", json_of(without)}};
}

}  // namespace slideway::charts
