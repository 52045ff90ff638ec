// The kernel among the contenders: a scene known when the program runs, or to the compiler.
#pragma once

#include <cmath>

#include "contender.hpp"

namespace slideway::charts {

template <class Source>
class KernelContender final : public Contender {
 public:
  KernelContender(const BasicStepper<Source>& stepper, const std::string& how) : stepper_(stepper) {
    family = slideway::name(stepper.method) + how;
    name = stepper.stabilise == Stabilise::projection ? "projected" : "Baumgarte";
    setting = "dt";
  }

  Outcome run(const std::vector<double>& times, double dt) const override {
    Outcome outcome;
    auto state = stepper_.start();
    double from = 0;
    for (const double to : times) {
      const long steps = std::lround((to - from) / dt);
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
      typename BasicStepper<Source>::Reaction r;
      const Report report = stepper_.reaction(state, {}, r);
      const int contacts = report.status == Status::ok ? int{stepper_.source.tables.contacts} : 0;
      outcome.q.emplace_back(state.q, state.q + stepper_.source.tables.coordinates);
      outcome.lambda.emplace_back(r.lambda, r.lambda + contacts);
    }
    return outcome;
  }

 private:
  BasicStepper<Source> stepper_;
};

/// All methods that apply, with Baumgarte's terms and projected; steps divide `interval`, three a decade.
template <class Source>
void add_methods(BasicStepper<Source> stepper, double interval, const std::string& how, Contenders& contenders) {
  for (const Method method : methods) {
    if (method == Method::kinematic && !fully_driven(stepper.source)) continue;
    for (const Stabilise stabilise : {Stabilise::baumgarte, Stabilise::projection}) {
      if (stabilise == Stabilise::projection && method == Method::kinematic) continue;
      stepper.method = method;
      stepper.stabilise = stabilise;
      auto contender = std::make_unique<KernelContender<Source>>(stepper, how);
      for (int k = 0; k < 24; ++k) contender->settings.push_back(interval / std::round(std::pow(10, k / 3.0)));
      contenders.push_back(std::move(contender));
    }
  }
}

}  // namespace slideway::charts
