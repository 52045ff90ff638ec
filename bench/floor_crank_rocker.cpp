// Time of one step of crank_rocker_offset: the floor, derived by hand (floor_crank_rocker.hpp).
//
//     floor_crank_rocker [Google Benchmark's options]
//     floor_crank_rocker --count N      N steps of the floor and a checksum, for callgrind: instructions per step are
//                                       the difference of two runs over the difference of their N
//
// All runs see the same states: the mechanism is let go at the same state every kRestart steps, since friction ends its
// motion.

#include "floor_crank_rocker.hpp"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

namespace fcr = floor_crank_rocker;

constexpr double kStep = 1e-3;  // s
constexpr int kRestart = 1000;  // steps: the guide slides until 1.38 s

/// The scene's start.
constexpr fcr::State3 kStart = {{1.0175863103546456, 0.0, 1.0175863103546456},
                                {0.70776318121606501, 3.0, -2.2922368187839350}};

/// The gains come from memory, as they do for a user.
fcr::Gains gains() {
  fcr::Gains g{20.0, 100.0};
  benchmark::DoNotOptimize(g);
  return g;
}

class Run {
 public:
  void step() {
    if (k_ == kRestart) {
      k_ = 0;
      state_ = kStart;
      signs_ = {1.0, 1.0};
    }
    ok_ = fcr::floor_step(state_, k_ * kStep, kStep, gains_, signs_) && ok_;
    ++k_;
  }
  bool ok() const { return ok_; }
  const fcr::State3& state() const { return state_; }

 private:
  fcr::Gains gains_ = gains();
  fcr::State3 state_ = kStart;
  fcr::Signs signs_{1.0, 1.0};
  int k_ = 0;
  bool ok_ = true;
};

void floor_step(benchmark::State& bench) {
  Run run;
  for (auto _ : bench) {
    run.step();
    benchmark::DoNotOptimize(run);
  }
  if (!run.ok()) bench.SkipWithError("a step of the floor was not finite");
}
BENCHMARK(floor_step);

int count(long steps) {
  Run run;
  for (long k = 0; k < steps; ++k) run.step();
  double checksum = 0.0;
  for (int i = 0; i < 3; ++i) checksum += run.state().q[i] + run.state().v[i];
  std::printf("%ld steps, checksum %a\n", steps, checksum);
  return run.ok() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--count") == 0) return count(std::strtol(argv[2], nullptr, 10));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
