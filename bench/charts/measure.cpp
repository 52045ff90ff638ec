#include "measure.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace slideway::charts {
namespace {

/// The reference in doubles, from its second sample on: the first is the start.
struct Truth {
  std::vector<double> times;
  std::vector<std::vector<double>> q, lambda;

  explicit Truth(const oracle::Reference& reference) {
    for (const auto& sample : reference.trajectory.samples) {
      if (sample.t == 0) continue;
      times.push_back(static_cast<double>(sample.t));
      q.push_back(doubles(sample.q));
      lambda.push_back(doubles(sample.lambda));
    }
  }
  static std::vector<double> doubles(const std::vector<oracle::Real>& numbers) {
    std::vector<double> all;
    for (const auto& x : numbers) all.push_back(static_cast<double>(x));
    return all;
  }
};

/// max |a - b| / max |b|; where b is all zero, max |a|.
double distance(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    for (std::size_t k = 0; k < b[i].size(); ++k) {
      const double difference = k < a[i].size() ? std::fabs(a[i][k] - b[i][k]) : HUGE_VAL;
      apart = difference > apart || std::isnan(difference) ? difference : apart;
      size = std::max(size, std::fabs(b[i][k]));
    }
  }
  return size > 0 ? apart / size : apart;
}

double seconds_of(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Times of the repetitions, by benchmark.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  explicit Collector(std::size_t expected, const MeasureOptions& options) : expected_(expected), options_(options) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      times[run.run_name.function_name].push_back(run.real_accumulated_time / static_cast<double>(run.iterations));
      options_.progress(static_cast<double>(++seen_) / static_cast<double>(expected_), "timed");
    }
  }
  std::map<std::string, std::vector<double>> times;  ///< s

 private:
  std::size_t expected_, seen_ = 0;
  const MeasureOptions& options_;
};

/// Is it worth timing: nobody of its family is as accurate in a third of the time?
bool is_beaten(const Measured& one, const std::vector<Measured>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Measured& other) {
    return other.failure.empty() && other.contender->family == one.contender->family && other.error <= one.error &&
           3 * other.ns < one.ns;
  });
}

}  // namespace

std::vector<Measured> measure(const Contenders& contenders, const oracle::Reference& reference,
                              const MeasureOptions& options) {
  const Truth truth(reference);
  const double span = truth.times.back();
  std::vector<Measured> all;
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const Contender& contender = *contenders[c];
    options.progress(static_cast<double>(c) / static_cast<double>(contenders.size()), contender.name);
    int worse = 0;  // settings in a row that gain nothing more
    double best = HUGE_VAL;
    for (const double setting : contender.settings) {
      Outcome outcome;
      const double seconds = seconds_of([&] { outcome = contender.run(truth.times, setting); });
      Measured m{&contender, setting, outcome.failure, 0, 0, outcome.evaluations, seconds * 1e9 / span, 0, 0};
      if (m.failure.empty()) {
        m.error = distance(outcome.q, truth.q);
        m.force_error = distance(outcome.lambda, truth.lambda);
        worse = m.error < 0.9 * best ? 0 : worse + 1;
        best = std::min(best, m.error);
      }
      all.push_back(m);
      if (seconds > options.longest || worse >= 4) break;
    }
  }

  std::map<std::string, Measured*> timed;
  for (Measured& m : all) {
    if (!m.failure.empty() || is_beaten(m, all)) continue;
    timed[fmt::format("{}/{}/{:g}", m.contender->family, m.contender->name, m.setting)] = &m;
  }
  benchmark::ClearRegisteredBenchmarks();
  for (const auto& [name, m] : timed) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [m = m, &truth](benchmark::State& state) {
                                   for (auto _ : state)
                                     benchmark::DoNotOptimize(m->contender->run(truth.times, m->setting));
                                 })
        ->UseRealTime()
        ->MinTime(0.01)
        ->Repetitions(options.repetitions);
  }
  char program[] = "charts", interleaved[] = "--benchmark_enable_random_interleaving=true";
  char* arguments[] = {program, interleaved, nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
  Collector collector(timed.size() * static_cast<std::size_t>(options.repetitions), options);
  benchmark::RunSpecifiedBenchmarks(&collector);
  for (auto& [name, m] : timed) {
    std::vector<double>& times = collector.times[name];
    if (times.empty()) continue;
    std::sort(times.begin(), times.end());
    m->ns = times[times.size() / 2] * 1e9 / span;
    m->ns_low = times.front() * 1e9 / span;
    m->ns_high = times.back() * 1e9 / span;
  }
  return all;
}

const Measured* cheapest(const std::vector<Measured>& all, const std::function<bool(const Contender&)>& among,
                         double error) {
  const Measured* best = nullptr;
  for (const Measured& m : all) {
    if (!m.failure.empty() || m.ns_low == 0 || m.error > error || !among(*m.contender)) continue;
    if (best == nullptr || m.ns < best->ns) best = &m;
  }
  return best;
}

}  // namespace slideway::charts
