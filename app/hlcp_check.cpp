#include "hlcp_check.hpp"

#include <fmt/format.h>

namespace slideway::app {
namespace {

using oracle::Count;

/// What the kernel promises of x: 4 (n + 1) 2^-53 of the terms' size as it computes it, and as much as n + 1 roundings
/// more in truth.
double residual_promised(int n) { return 5 * (n + 1) * 0x1p-53; }

bool is_true(Uniqueness claim, const oracle::ExactAnswer& exact) {
  switch (claim) {
    case Uniqueness::certified:
      return exact.w_property;
    case Uniqueness::single:
      return !exact.w_property && exact.count() == Count::one;
    case Uniqueness::refuted:
      return exact.count() == Count::several || exact.count() == Count::continuum;
    case Uniqueness::unproven:
    case Uniqueness::motion_only:
      break;
  }
  return true;
}

std::string w_property(const oracle::ExactAnswer& exact) {
  return exact.w_property ? "the W-property holds" : "the W-property does not hold";
}

void measure(const HlcpProblem& problem, const oracle::ExactHlcp& exact, HlcpCheck& check) {
  const oracle::Exact x = oracle::exact_vector(check.kernel.x, problem.n);
  check.residual = oracle::nearest_double(residual(exact, x));
  if (!check.exact) return;
  for (std::size_t k = 0; k < check.exact->isolated.size(); ++k) {
    const double away = oracle::nearest_double(oracle::distance(x, check.exact->isolated[k]));
    if (check.nearest >= 0 && away >= check.distance) continue;
    check.nearest = static_cast<int>(k);
    check.distance = away;
  }
}

/// An x that misses no equation beyond the promise is an exact solution of a problem that differs by as much from this
/// one, entry by entry: that is what doubles can do, and how far from the exact solution it lies is the problem's
/// condition. What is left to hold against the exact answer is whether there is a solution, and what was claimed of
/// its being the only one.
void judge_solution(const HlcpProblem& problem, HlcpCheck& check) {
  const char* claim = name(check.kernel.uniqueness);
  const double promised = residual_promised(problem.n);
  if (!(check.residual <= promised)) {
    check.verdict =
        fmt::format("disagree: the kernel's x misses an equation by {:.2g} of its terms, and promised {:.2g}",
                    check.residual, promised);
  } else if (!check.exact) {
    check.agree = true;
    check.verdict =
        fmt::format("the kernel's x satisfies the equations; above order {} its uniqueness ({}) is not checked",
                    oracle::exact_max_order, claim);
  } else if (check.exact->count() == Count::none) {
    check.verdict = "disagree: the kernel has a solution; exact: no solution";
  } else if (!is_true(check.kernel.uniqueness, *check.exact)) {
    check.verdict = fmt::format("disagree: the kernel says {}; exact: {}, {}", claim, describe(*check.exact),
                                w_property(*check.exact));
  } else {
    check.agree = true;
    check.verdict = fmt::format("agree: {}", describe(*check.exact));
  }
}

void judge_refusal(HlcpCheck& check) {
  const bool none = check.kernel.status == Status::no_solution;
  if (!none && check.kernel.status != Status::not_unique) {
    check.verdict = fmt::format("the kernel does not decide this problem: {}", name(check.kernel.status));
  } else if (!check.exact) {
    check.verdict = fmt::format("the kernel says {}; above order {} that is not checked", name(check.kernel.status),
                                oracle::exact_max_order);
  } else {
    const Count count = check.exact->count();
    check.agree = none ? count == Count::none : count == Count::several || count == Count::continuum;
    check.verdict = check.agree ? fmt::format("agree: {}", describe(*check.exact))
                                : fmt::format("disagree: the kernel says {}; exact: {}", name(check.kernel.status),
                                              describe(*check.exact));
  }
}

}  // namespace

std::string describe(const oracle::ExactAnswer& answer) {
  switch (answer.count()) {
    case Count::none:
      return "no solution";
    case Count::one:
      return "one solution";
    case Count::several:
      return fmt::format("{} solutions", answer.isolated.size());
    case Count::continuum:
      break;
  }
  return "a continuum of solutions";
}

HlcpCheck check_hlcp(const HlcpProblem& problem, const HlcpKernel& kernel) {
  HlcpCheck check;
  check.kernel = kernel;
  const oracle::ExactHlcp exact = oracle::exact_hlcp(problem.n, problem.data.plus, problem.data.minus, problem.data.b);
  if (problem.n <= oracle::exact_max_order) check.exact = oracle::solve(exact);
  if (check.solved()) {
    measure(problem, exact, check);
    judge_solution(problem, check);
  } else {
    judge_refusal(check);
  }
  return check;
}

}  // namespace slideway::app
