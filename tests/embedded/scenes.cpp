// Every shipped scene by every method, as compile-time and as run-time scene: the same bits. Prints the last state and
// reaction of each in hex, so that two compilers' programs can be compared; exit 1 where the two scenes differ.
#include <cstdio>
#include <cstring>

#include "../support/scenes.hpp"

namespace {

using slideway::Method;
using slideway::Status;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// q, v, contact forces and drive forces of two steppers agree to the bit.
template <class Known, class Wide>
bool agree(const Known& known, const Wide& wide, const typename Known::State& a, const typename Wide::State& b) {
  typename Known::Reaction ra{};
  typename Wide::Reaction rb{};
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
bool run(const char* name, Known known, double dt, int steps, Method method) {
  using Wide = slideway::RunTimeStepper<slideway::test::WideSize>;
  known.method = method;
  static Wide wide(slideway::test::widen(known.source.scene));
  wide = Wide(slideway::test::widen(known.source.scene));
  wide.method = method;
  auto a = known.start();
  auto b = wide.start();
  Status status = Status::ok;
  bool same = true;
  int step = 0;
  for (; step < steps && status == Status::ok; ++step) {
    const slideway::Report ra = known.step(a, dt), rb = wide.step(b, dt);
    status = ra.status;
    same = same && ra.status == rb.status && same_bits(ra.residual, rb.residual) && ra.solves == rb.solves &&
           ra.unlocated_events == rb.unlocated_events && same_bits(ra.energy.dissipated, rb.energy.dissipated);
  }
  std::printf("%s %s: %d steps, %s\n", name, slideway::name(method), step, slideway::name(status));
  same = agree(known, wide, a, b) && same;
  if (!same) std::fprintf(stderr, "%s %s: compile-time and run-time scene differ\n", name, slideway::name(method));
  return same;
}

}  // namespace

int main() {
  bool same = true;
  slideway::test::for_each_scene([&](const char* name, const auto& stepper, double dt, int steps) {
    for (const Method method : slideway::methods) {
      same = run(name, stepper, dt, steps, method) && same;
    }
  });
  return same ? 0 : 1;
}
