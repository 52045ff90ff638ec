// One shipped scene by every method, as compile-time and as run-time scene: the same bits. CMakeLists.txt writes the
// programs, one for each scene, so that all cores compile; wide.cpp is what they share.
#pragma once

#include <cstdio>
#include <cstring>
#include <slideway/step.hpp>

namespace slideway::test {

/// Room for all shipped scenes.
using WideSize = Size<33, 33, 16, 32, 4, 4, 2, 2, 2, 2>;
using Wide = RunTimeStepper<WideSize>;

/// The same scene with room to spare.
template <class Exact>
constexpr Scene<WideSize> widen(const Scene<Exact>& scene) {
  Scene<WideSize> wide;
  wide.gravity = scene.gravity;
  wide.alpha = scene.alpha;
  wide.beta = scene.beta;
  const auto copy = [](const auto& from, auto& to, int count, int& to_count) {
    for (int i = 0; i < count; ++i) to[i] = from[i];
    to_count = count;
  };
  copy(scene.body, wide.body, scene.bodies, wide.bodies);
  copy(scene.guide, wide.guide, scene.guides, wide.guides);
  copy(scene.drive, wide.drive, scene.drives, wide.drives);
  copy(scene.pin, wide.pin, scene.pins, wide.pins);
  copy(scene.spring, wide.spring, scene.springs, wide.springs);
  copy(scene.joint_spring, wide.joint_spring, scene.joint_springs, wide.joint_springs);
  copy(scene.load, wide.load, scene.loads, wide.loads);
  wide.inputs = scene.inputs;
  return wide;
}

inline bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// q, v, contact forces and drive forces of two steppers agree to the bit.
template <class Known>
bool agree(const Known& known, const Wide& wide, const typename Known::State& a, const Wide::State& b) {
  typename Known::Reaction ra{};
  Wide::Reaction rb{};
  bool same = known.reaction(a, {}, ra).status == wide.reaction(b, {}, rb).status;
  const auto& table = known.source.tables;
  const auto compare = [&](const char* what, const double* x, const double* y, int count) {
    for (int i = 0; i < count; ++i) {
      if (!same_bits(x[i], y[i])) std::printf("  differ: %s[%d] %a %a\n", what, i, x[i], y[i]);
      same = same && same_bits(x[i], y[i]);
      std::printf(" %s[%d] %a\n", what, i, x[i]);
    }
  };
  compare("q", a.q, b.q, table.coordinates);
  compare("v", a.v, b.v, table.coordinates);
  compare("lambda", ra.lambda, rb.lambda, table.contacts);
  compare("friction", ra.friction, rb.friction, known.source.scene.guides);
  compare("drive", ra.drive, rb.drive, known.source.scene.drives);
  return same;
}

template <class Known>
bool run(Known known, double dt, int steps, Method method) {
  known.method = method;
  static Wide wide(widen(known.source.scene));
  wide.method = method;
  auto a = known.start();
  auto b = wide.start();
  Status status = Status::ok;
  bool same = true;
  int step = 0;
  for (; step < steps && status == Status::ok; ++step) {
    const Report ra = known.step(a, dt), rb = wide.step(b, dt);
    status = ra.status;
    same = same && ra.status == rb.status && same_bits(ra.residual, rb.residual) && ra.solves == rb.solves &&
           ra.unlocated_events == rb.unlocated_events && same_bits(ra.energy.dissipated, rb.energy.dissipated);
  }
  std::printf("%s: %d steps, %s\n", name(method), step, name(status));
  same = agree(known, wide, a, b) && same;
  if (!same) std::fprintf(stderr, "%s: compile-time and run-time scene differ\n", name(method));
  return same;
}

/// Prints the last state and reaction of each method in hex, so that two compilers' programs can be compared; 1, the
/// program's exit status, where the two scenes differ.
template <const auto& scene>
int same_bits_of(double dt, int steps) {
  bool same = true;
  for (const Method method : methods) same = run(Stepper<scene>{}, dt, steps, method) && same;
  return same ? 0 : 1;
}

}  // namespace slideway::test

namespace slideway {
extern template class BasicStepper<RunTime<test::WideSize>>;
}
