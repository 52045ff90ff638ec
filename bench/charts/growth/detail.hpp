// What detail costs: one machine modelled at several depths, ns a step against the difference of the answer.
#pragma once

#include <functional>
#include <slideway/io/json.hpp>

#include "figure.hpp"

namespace slideway::charts {

/// A machine's answer over a run, at equally distant times: what is asked of any model of it.
struct Answer {
  std::vector<double> place;   ///< of the slider, x and y, m
  std::vector<double> normal;  ///< force of the guide, its contacts together, N
  std::vector<double> torque;  ///< of the drive, N m; empty without one
};

struct Model {
  std::string name;
  Style style;
  std::function<Answer()> answer;
  std::function<void()> run;  ///< without looking at it
};

/// A machine and its models, the most detailed first.
struct Machine {
  std::string name;  ///< of the scene
  bool driven;
  int steps;
  double dt;                              ///< s
  std::function<Answer()> most_detailed;  ///< of the first model, solved far more accurately than any run
  std::vector<Model> models;
};

Machine driven_machine();    ///< slider_crank_driven
Machine undriven_machine();  ///< crank_rocker_offset, up to where its crank turns back

struct Detail {
  std::string model;
  Style style;
  double ns, low, high;          ///< a step: median, least, most
  double place, normal, torque;  ///< max |difference| / max |value|
  double largest() const;
};

std::vector<Detail> measure_detail(const Machine& machine, int repetitions,
                                   const std::function<void(double, const std::string&)>& progress);
Chart detail_chart(const Machine& machine, const std::vector<Detail>& details);
io::Json document(const Machine& machine, const std::vector<Detail>& details);

}  // namespace slideway::charts
