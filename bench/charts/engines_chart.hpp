// slideway against general engines on the free crank-rocker, with friction and without.
#pragma once

#include "engines.hpp"
#include "work_precision.hpp"

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

/// The cheapest step of an engine, and the cheapest of the kernel whose error is below the engine's least.
struct StepRatio {
  const Measured *engine = nullptr, *kernel = nullptr;  ///< null: none was timed
  double engine_ns = 0, kernel_ns = 0;                  ///< of a step
  double least_error = 0;                               ///< of the engine, at any cost
};
StepRatio step_ratio(const EngineComparison& comparison, const Engine& engine);

io::Json document(const EngineComparison& with_friction, const EngineComparison& without);

}  // namespace slideway::charts
