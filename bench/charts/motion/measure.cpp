#include "measure.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "timing.hpp"

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

  std::vector<Measured*> timed;
  std::vector<Run> runs;
  for (Measured& m : all) {
    if (!m.failure.empty() || is_beaten(m, all)) continue;
    timed.push_back(&m);
    runs.push_back({fmt::format("{}/{}/{:g}", m.contender->family, m.contender->name, m.setting),
                    [&m, &truth] { benchmark::DoNotOptimize(m.contender->run(truth.times, m.setting)); }, span});
  }
  const std::vector<Timing> times = time_in_turns(runs, options.repetitions, 0.01, options.progress);
  for (std::size_t k = 0; k < timed.size(); ++k) {
    timed[k]->ns = times[k].ns;
    timed[k]->ns_low = times[k].low;
    timed[k]->ns_high = times[k].high;
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
