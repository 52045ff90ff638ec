// slideway against general engines on the free crank-rocker, with friction and without.
#pragma once

#include "engines.hpp"
#include "motion/work_precision.hpp"

namespace slideway::charts {

/// Scene, what the engines make of it, and what was measured.
struct EngineComparison {
  std::unique_ptr<RunScene> scene;
  std::unique_ptr<CrankMechanism> mechanism;
  WorkPrecision measured;
};

/// The scene that the compiler knows: `crank_rocker_offset`.
inline constexpr const char* engine_scene = "crank_rocker_offset";

std::vector<Engine> engines();

/// With friction, against the stored reference; or with mu = 0, where the engines' models are exact, against a fine run
/// of dop853_located.
EngineComparison compare_engines(const io::SceneFile& scene, const oracle::Reference& reference, bool frictional,
                                 const MeasureOptions& options);

Chart engines_chart(const EngineComparison& comparison);

/// A step of an engine's setting, and the kernel's cheapest step whose error is below that setting's least.
struct StepRatio {
  const Measured *engine = nullptr, *kernel = nullptr;
  double least_error = 0;  ///< of the engine's setting, at any length of step

  double engine_ns() const;
  double kernel_ns() const;
  double ratio() const { return engine_ns() / kernel_ns(); }
};
/// Of each setting of an engine that was timed with steps of one length, where the kernel has such a step.
std::vector<StepRatio> step_ratios(const EngineComparison& comparison, const Engine& engine);
/// The least of them; null if there is none.
const StepRatio* least_ratio(const std::vector<StepRatio>& ratios);

io::Json document(const EngineComparison& with_friction, const EngineComparison& without);

}  // namespace slideway::charts
