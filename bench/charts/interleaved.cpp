#include "interleaved.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

namespace slideway::charts {
namespace {

/// Times of the repetitions, by benchmark.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  Collector(std::size_t expected, const std::function<void(double)>& progress)
      : expected_(expected), progress_(progress) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      ns[run.run_name.function_name].push_back(1e9 * run.cpu_accumulated_time / static_cast<double>(run.iterations));
      progress_(static_cast<double>(++seen_) / static_cast<double>(expected_));
    }
  }
  std::map<std::string, std::vector<double>> ns;

 private:
  std::size_t expected_, seen_ = 0;
  const std::function<void(double)>& progress_;
};

}  // namespace

void time_interleaved(std::vector<Timed>& all, int repetitions, double least,
                      const std::function<void(double part)>& progress) {
  benchmark::ClearRegisteredBenchmarks();
  for (const Timed& one : all) {
    benchmark::RegisterBenchmark(one.name.c_str(),
                                 [&one](benchmark::State& state) {
                                   for (auto _ : state) one.run();
                                 })
        ->MinTime(least)
        ->Repetitions(repetitions);
  }
  char program[] = "charts", interleaved[] = "--benchmark_enable_random_interleaving=true";
  char* arguments[] = {program, interleaved, nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
  Collector collector(all.size() * static_cast<std::size_t>(repetitions), progress);
  benchmark::RunSpecifiedBenchmarks(&collector);
  for (Timed& one : all) {
    std::vector<double>& ns = collector.ns[one.name];
    if (ns.empty()) continue;
    std::sort(ns.begin(), ns.end());
    one.ns = ns[ns.size() / 2];
    one.ns_low = ns.front();
    one.ns_high = ns.back();
  }
}

}  // namespace slideway::charts
