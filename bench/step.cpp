// Cost of one rk4 step with its self-check: compile-time scene, run-time scene, rk4_located (with the events of the
// run), and for crank_rocker_offset the floor, a step derived by hand for that mechanism alone, without any check
// (floor_crank_rocker.hpp).
//
//     step [Google Benchmark's options]
//     step --ratio                 medians of interleaved runs, and their ratios
//     step --count SIDE N          N steps, their events and a checksum, for callgrind (bench/count)
//     step --memory                bytes of the compile-time crank_rocker
//
// All sides see the same states: a mechanism is let go at its start again every `restart` steps.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <slideway/io/scene_file.hpp>
#include <slideway/io/stepper.hpp>
#include <slideway/scenes/crank_rocker.hpp>
#include <slideway/scenes/crank_rocker_offset.hpp>
#include <slideway/scenes/v_engine_16.hpp>
#include <slideway/scenes/v_engine_2.hpp>
#include <slideway/scenes/v_engine_4.hpp>
#include <slideway/scenes/v_engine_8.hpp>
#include <slideway/self_test.hpp>
#include <string>
#include <vector>

#include "floor_crank_rocker.hpp"

namespace {

/// The room that `slideway run` gives a scene.
using Room = slideway::io::RunSize;

template <class Exact>
slideway::Scene<Room> at_run_time(const Exact& scene) {
  slideway::Scene<Room> room;
  room.gravity = scene.gravity;
  room.alpha = scene.alpha;
  room.beta = scene.beta;
  room.bodies = scene.bodies;
  room.guides = scene.guides;
  std::copy_n(scene.body, scene.bodies, room.body);
  std::copy_n(scene.guide, scene.guides, room.guide);
  benchmark::DoNotOptimize(room);
  return room;
}

/// Steps a scene, from its start again every `restart` steps.
template <class Stepper>
class Run {
 public:
  Run(const Stepper& stepper, double dt, int restart)
      : stepper_(stepper), dt_(dt), restart_(restart), start_(stepper.start()), state_(start_) {}
  void step() {
    if (k_ == restart_) {
      k_ = 0;
      state_ = start_;
    }
    const slideway::Report report = stepper_.step(state_, dt_);
    ok_ = report.status == slideway::Status::ok && ok_;
    events_ += report.events + report.unlocated_events;
    ++k_;
  }
  bool ok() const { return ok_; }
  int events() const { return events_; }
  double checksum() const { return state_.q[0] + state_.v[0]; }

 private:
  Stepper stepper_;
  double dt_;
  int restart_;
  typename Stepper::State start_, state_;
  int k_ = 0, events_ = 0;
  bool ok_ = true;
};

/// The floor, on the same states.
class Floor {
 public:
  void step() {
    if (k_ == restart) {
      k_ = 0;
      state_ = start();
      signs_ = {1.0, 1.0};
    }
    ok_ = floor_crank_rocker::floor_step(state_, k_ * dt, dt, gains_, signs_) && ok_;
    ++k_;
  }
  bool ok() const { return ok_; }
  int events() const { return 0; }  // of none it knows
  double checksum() const { return state_.q[0] + state_.v[0]; }

  static constexpr double dt = 1e-3;
  static constexpr int restart = 1000;  // the guide slides until 1.38 s

 private:
  static floor_crank_rocker::State3 start() {
    floor_crank_rocker::State3 state{};
    for (int i = 0; i < 3; ++i) {
      state.q[i] = crank_rocker_offset.body[i].q[0];
      state.v[i] = crank_rocker_offset.body[i].v[0];
    }
    return state;
  }
  static floor_crank_rocker::Gains gains() {  // from memory, as a user's are
    floor_crank_rocker::Gains g{20.0, 100.0};
    benchmark::DoNotOptimize(g);
    return g;
  }
  floor_crank_rocker::Gains gains_ = gains();
  floor_crank_rocker::State3 state_ = start();
  floor_crank_rocker::Signs signs_{1.0, 1.0};
  int k_ = 0;
  bool ok_ = true;
};

/// f(name, run) for every side.
template <class F>
void for_each_side(F&& f) {
  const auto sides = [&](const std::string& name, const auto& known, const auto& scene, double dt, int restart) {
    const slideway::RunTimeStepper<Room> run_time(at_run_time(scene));
    auto located = known;
    located.method = slideway::Method::rk4_located;
    f(name, Run(known, dt, restart));
    f(name + "_run_time", Run(run_time, dt, restart));
    f(name + "_located", Run(located, dt, restart));
  };
  f("floor", Floor());
  sides("crank_rocker_offset", slideway::Stepper<crank_rocker_offset>{}, crank_rocker_offset, Floor::dt,
        Floor::restart);
  sides("v_engine_2", slideway::Stepper<v_engine_2>{}, v_engine_2, 5e-5, 1000);
  sides("v_engine_4", slideway::Stepper<v_engine_4>{}, v_engine_4, 5e-5, 1000);
  sides("v_engine_8", slideway::Stepper<v_engine_8>{}, v_engine_8, 5e-5, 1000);
  sides("v_engine_16", slideway::Stepper<v_engine_16>{}, v_engine_16, 5e-5, 1000);
}

int count(const std::string& side, long steps) {
  int result = 2;
  for_each_side([&](const std::string& name, auto run) {
    if (name != side) return;
    for (long k = 0; k < steps; ++k) run.step();
    std::printf("%s: %ld steps, %d events, checksum %a\n", name.c_str(), steps, run.events(), run.checksum());
    result = run.ok() ? 0 : 1;
  });
  if (result == 2) std::fprintf(stderr, "no side '%s'\n", side.c_str());
  return result;
}

/// Median of `rounds` interleaved runs of a thousand steps, ns a step.
int print_ratios() {
  constexpr int rounds = 41, steps = 1000;
  std::vector<std::string> names;
  std::vector<std::vector<double>> times;
  for (int round = 0; round < rounds; ++round) {
    std::size_t side = 0;
    for_each_side([&](const std::string& name, auto run) {
      const auto begin = std::chrono::steady_clock::now();
      for (int k = 0; k < steps; ++k) run.step();
      const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - begin;
      if (!run.ok()) std::printf("%s was refused\n", name.c_str());
      if (round == 0) {
        names.push_back(name);
        times.emplace_back();
      }
      times[side++].push_back(elapsed.count() / steps);
    });
  }
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  for (std::size_t side = 0; side < names.size(); ++side) {
    std::printf("%-30s %9.1f ns a step", names[side].c_str(), median(times[side]));
    if (side == 1) std::printf("   %.2f x floor", median(times[side]) / median(times[0]));
    if (side % 3 == 2) std::printf("   %.2f x compile time", median(times[side]) / median(times[side - 1]));
    if (side > 0 && side % 3 == 0) std::printf("   %.2f x rk4", median(times[side]) / median(times[side - 2]));
    std::printf("\n");
  }
  return 0;
}

int print_memory() {
  using Stepper = slideway::Stepper<crank_rocker>;
  using Size = Stepper::Size;
  std::printf("state %zu, scene %zu, tables %zu, work %zu bytes\n", sizeof(Stepper::State), sizeof(crank_rocker),
              sizeof(slideway::Tables<Size>),
              sizeof(slideway::Work<Size>) + sizeof(slideway::Problem<slideway::CompileTime<crank_rocker>>) +
                  sizeof(Stepper::Reaction));
  return 0;
}

void register_all() {
  for_each_side([](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(
        name.c_str(),
        [](benchmark::State& bench, auto side) {
          for (auto _ : bench) {
            side.step();
            benchmark::DoNotOptimize(side);
          }
          if (!side.ok()) bench.SkipWithError("a step was refused");
        },
        run);
  });
  benchmark::RegisterBenchmark("self_test", [](benchmark::State& bench) {
    for (auto _ : bench) {
      if (slideway::self_test() != slideway::SelfTest::passed) bench.SkipWithError("the self-test did not pass");
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--count") == 0) return count(argv[2], std::strtol(argv[3], nullptr, 10));
  if (argc == 2 && std::strcmp(argv[1], "--ratio") == 0) return print_ratios();
  if (argc == 2 && std::strcmp(argv[1], "--memory") == 0) return print_memory();
  register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
