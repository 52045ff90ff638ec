#include "timing.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

namespace slideway::charts {
namespace {

class Collector final : public benchmark::BenchmarkReporter {
 public:
  Collector(std::size_t expected, const std::function<void(double, const std::string&)>& progress)
      : expected_(expected), progress_(progress) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      seconds[run.run_name.function_name].push_back(run.cpu_accumulated_time / static_cast<double>(run.iterations));
      progress_(static_cast<double>(++seen_) / static_cast<double>(expected_), "timed");
    }
  }
  std::map<std::string, std::vector<double>> seconds;

 private:
  std::size_t expected_, seen_ = 0;
  const std::function<void(double, const std::string&)>& progress_;
};

}  // namespace

std::vector<Timing> time_in_turns(const std::vector<Run>& runs, int repetitions, double seconds,
                                  const std::function<void(double, const std::string&)>& progress) {
  benchmark::ClearRegisteredBenchmarks();
  for (const Run& run : runs) {
    benchmark::RegisterBenchmark(run.name.c_str(),
                                 [&run](benchmark::State& state) {
                                   for (auto _ : state) run.go();
                                 })
        ->MeasureProcessCPUTime()
        ->MinTime(seconds)
        ->Repetitions(repetitions);
  }
  char program[] = "charts", in_turns[] = "--benchmark_enable_random_interleaving=true";
  char* arguments[] = {program, in_turns, nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
  Collector collector(runs.size() * static_cast<std::size_t>(repetitions), progress);
  benchmark::RunSpecifiedBenchmarks(&collector);
  std::vector<Timing> all;
  for (const Run& run : runs) {
    std::vector<double>& times = collector.seconds[run.name];
    std::sort(times.begin(), times.end());
    const double each = 1e9 / run.parts;
    all.push_back(times.empty() ? Timing{}
                                : Timing{each * times[times.size() / 2], each * times.front(), each * times.back()});
  }
  return all;
}

}  // namespace slideway::charts
