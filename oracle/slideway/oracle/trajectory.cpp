#include <mpfr.h>

#include <future>
#include <slideway/oracle/trajectory.hpp>

namespace slideway::oracle {

template class Integrator<Real>;

namespace {

constexpr std::size_t energies = 6;  ///< from this kind on

/// Every number of an instant, by kinds.
std::vector<std::vector<Real>> kinds(const Instant<Real>& i) {
  return {i.q, i.v, i.lambda, i.friction, i.drive, i.pin, {i.energy, i.work, i.dissipated}};
}

/// Largest error of a kind over its largest magnitude.
Real relative_error(const Trajectory<Real>& a, const Trajectory<Real>& b, std::size_t kind) {
  Real error(0), scale(0);
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    const auto x = kinds(a.samples[i])[kind], y = kinds(b.samples[i])[kind];
    for (std::size_t j = 0; j < x.size(); ++j) {
      error = worse(error, Real(abs(x[j] - y[j])));
      scale = std::max(scale, Real(abs(x[j])));
    }
    if (kind == energies) scale = std::max({scale, a.samples[i].kinetic, b.samples[i].kinetic});
  }
  return scale > 0 ? Real(error / scale) : Real(0);
}

}  // namespace

double shared_digits(const Trajectory<Real>& a, const Trajectory<Real>& b) {
  if (a.samples.size() != b.samples.size() || a.events.size() != b.events.size() || a.end != b.end) return 0;
  Real worst(0);
  for (std::size_t kind = 0; !a.samples.empty() && kind < kinds(a.samples.front()).size(); ++kind) {
    worst = worse(worst, relative_error(a, b, kind));
  }
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    const auto &x = a.events[i], &y = b.events[i];
    if (x.guide != y.guide || x.contact != y.contact || x.kind != y.kind) return 0;
    worst = worse(worst, Real(abs(x.t - y.t) / a.t));
  }
  constexpr double most = std::numeric_limits<Real>::digits10;
  return worst == 0 ? most : worst < 1 ? std::min(most, -static_cast<double>(log10(worst))) : 0;
}

Validated integrate_twice(const Model<Real>& model, const Real& duration, const std::vector<Real>& times,
                          const TrajectoryOptions& options) {
  TrajectoryOptions better = options;
  better.digits += 6;
  better.step *= 0.8;
  TrajectoryOptions quiet = options;
  quiet.progress = [](double) {};
  auto other = std::async(std::launch::async, [&] {
    Trajectory<Real> result = Integrator<Real>(model, quiet).run(duration, times);
    mpfr_free_cache();  // of this thread
    return result;
  });
  Trajectory<Real> trajectory = Integrator<Real>(model, better).run(duration, times);
  const double digits = shared_digits(trajectory, other.get());
  return {std::move(trajectory), digits};
}

}  // namespace slideway::oracle
