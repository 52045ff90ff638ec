#include <fmt/format.h>

#include <cmath>
#include <slideway/hlcp.hpp>
#include <slideway/properties/hlcp.hpp>

namespace slideway::properties {
namespace {

using oracle::Count;

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

void measure(const HlcpCase& problem, const oracle::ExactHlcp& exact, oracle::Want want, HlcpCheck& check) {
  check.residual = residual(exact, check.answer.x);
  if (!check.exact || want == oracle::Want::counts) return;
  const oracle::Exact x = oracle::exact_vector(check.answer.x, problem.n);
  for (std::size_t k = 0; k < check.exact->isolated.size(); ++k) {
    const double away = oracle::nearest_double(oracle::distance(x, check.exact->isolated[k]));
    if (check.nearest >= 0 && away >= check.distance) continue;
    check.nearest = static_cast<int>(k);
    check.distance = away;
  }
}

/// Only agree or disagree: an x is a claim.
void judge_solution(double promised, HlcpCheck& check) {
  const char* claim = name(check.answer.uniqueness);
  if (!(check.residual <= promised)) {
    check.verdict =
        fmt::format("disagree: the answer's x misses an equation by {:.2g} of its terms, and promised {:.2g}",
                    check.residual, promised);
  } else if (!check.exact) {
    check.judgement = Judgement::agree;
    check.verdict =
        fmt::format("the answer's x satisfies the equations; above order {} its uniqueness ({}) is not checked",
                    oracle::exact_max_order, claim);
  } else if (check.exact->count() == Count::none) {
    check.verdict = "disagree: the answer has a solution; exact: no solution";
  } else if (!is_true(check.answer.uniqueness, *check.exact)) {
    check.verdict = fmt::format("disagree: the answer says {}; exact: {}, {}", claim, describe(*check.exact),
                                w_property(*check.exact));
  } else {
    check.judgement = Judgement::agree;
    check.verdict = fmt::format("agree: {}", describe(*check.exact));
  }
}

void judge_refusal(HlcpCheck& check) {
  const bool none = check.answer.status == Status::no_solution;
  const char* claim = name(check.answer.status);
  if (!none && check.answer.status != Status::not_unique) {
    check.judgement = Judgement::silent;
    check.verdict = fmt::format("nothing is said of this problem: {}", claim);
  } else if (!check.exact) {
    check.judgement = Judgement::silent;
    check.verdict =
        fmt::format("the answer says {}; above order {} that is not checked", claim, oracle::exact_max_order);
  } else {
    const Count count = check.exact->count();
    const bool agree = none ? count == Count::none : count == Count::several || count == Count::continuum;
    check.judgement = agree ? Judgement::agree : Judgement::disagree;
    check.verdict = agree ? fmt::format("agree: {}", describe(*check.exact))
                          : fmt::format("disagree: the answer says {}; exact: {}", claim, describe(*check.exact));
  }
}

bool all_finite(const HlcpAnswer& answer, int n) {
  for (int k = 0; k < n; ++k) {
    if (!std::isfinite(answer.x[k])) return false;
  }
  return true;
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

HlcpCheck check_hlcp(const HlcpCase& problem, const HlcpAnswer& answer, double residual, oracle::Want want) {
  HlcpCheck check;
  check.answer = answer;
  const oracle::ExactHlcp exact = oracle::exact_hlcp(problem.n, problem.data.plus, problem.data.minus, problem.data.b);
  if (problem.n <= oracle::exact_max_order) check.exact = oracle::solve(exact, want);
  if (!check.solved()) {
    judge_refusal(check);
  } else if (!all_finite(answer, problem.n)) {
    check.verdict = "disagree: the answer's x is not finite";
  } else {
    measure(problem, exact, want, check);
    judge_solution(residual, check);
  }
  return check;
}

HlcpAnswer kernel_answer(const HlcpCase& problem, unsigned long long start, HlcpOptions options) {
  HlcpAnswer answer = {};
  for (int k = 0; k < problem.n; ++k) answer.sign[k] = static_cast<signed char>((start >> k & 1u) != 0 ? -1 : 1);
  slideway::solve(problem.data, problem.n, answer, options);
  return answer;
}

HlcpCase lcp_case(int n, const double* m, const double* q) {
  HlcpCase problem{n, {}};
  for (int i = 0; i < n; ++i) {
    problem.data.plus[i][i] = 1;
    for (int j = 0; j < n; ++j) problem.data.minus[i][j] = m[i * n + j];
    problem.data.b[i] = q[i];
  }
  return problem;
}

HlcpAnswer lcp_answer(const HlcpCase& lcp, const double* z) {
  HlcpAnswer answer = {};
  for (int i = 0; i < lcp.n; ++i) {
    double w = lcp.data.b[i];
    for (int j = 0; j < lcp.n; ++j) w += lcp.data.minus[i][j] * z[j];
    answer.x[i] = z[i] > w ? -z[i] : w;
    if (!(z[i] <= w) && !(z[i] > w)) answer.x[i] = std::nan("");
  }
  answer.uniqueness = Uniqueness::unproven;
  return answer;
}

HlcpAnswer no_answer() {
  HlcpAnswer answer = {};
  answer.status = Status::solve_limit;
  answer.uniqueness = Uniqueness::unproven;
  return answer;
}

std::string json(const HlcpCase& problem) {
  const auto row = [&](const double* x) {
    std::string text;
    for (int j = 0; j < problem.n; ++j) text += fmt::format("{}{}", j > 0 ? ", " : "", x[j]);
    return "[" + text + "]";
  };
  const auto matrix = [&](const auto& rows) {
    std::string text;
    for (int i = 0; i < problem.n; ++i) text += (i > 0 ? ", " : "") + row(rows[i]);
    return "[" + text + "]";
  };
  return fmt::format("{{\"A_plus\": {}, \"A_minus\": {}, \"b\": {}}}", matrix(problem.data.plus),
                     matrix(problem.data.minus), row(problem.data.b));
}

}  // namespace slideway::properties
