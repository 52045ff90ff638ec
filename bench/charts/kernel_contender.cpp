#include <cmath>

#include "contender.hpp"

namespace slideway::charts {
namespace {

class Kernel final : public Contender {
 public:
  Kernel(const RunScene& scene, Method method) : stepper_(scene) {
    stepper_.method = method;
    family = name = slideway::name(method);
    setting = "dt";
  }

  Outcome run(const std::vector<double>& times, double dt) const override {
    Outcome outcome;
    auto state = stepper_.start();
    double from = 0;
    for (const double to : times) {
      const auto steps = std::lround((to - from) / dt);
      const double h = (to - from) / static_cast<double>(steps);
      for (long k = 0; k < steps; ++k) {
        const Report report = stepper_.step(state, h);
        outcome.evaluations += report.evaluations;
        if (report.status != Status::ok) {
          outcome.failure = slideway::name(report.status);
          return outcome;
        }
      }
      from = to;
      Reaction<Size> r;
      const Report report = stepper_.reaction(state, {}, r);
      outcome.q.emplace_back(state.q, state.q + stepper_.source.tables.coordinates);
      if (report.status == Status::ok) {
        outcome.lambda.emplace_back(r.lambda, r.lambda + stepper_.source.tables.contacts);
      } else {
        outcome.lambda.emplace_back();
      }
    }
    return outcome;
  }

 private:
  io::RunStepper stepper_;
};

}  // namespace

void add_kernel(const RunScene& scene, double interval, double coarsest, Contenders& contenders) {
  const io::RunStepper probe(scene);
  for (const Method method : methods) {
    if (method == Method::kinematic && !fully_driven(probe.source)) continue;
    auto kernel = std::make_unique<Kernel>(scene, method);
    const double first = std::ceil(interval / coarsest);
    for (int k = 0; k < 40; ++k) {  // three steps a decade
      const double steps = std::round(first * std::pow(10, k / 3.0));
      kernel->settings.push_back(interval / steps);
    }
    contenders.push_back(std::move(kernel));
  }
}

}  // namespace slideway::charts
