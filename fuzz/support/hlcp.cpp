#include "support/hlcp.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <slideway/hlcp.hpp>

#include "support/fail.hpp"

namespace slideway::fuzz {
namespace {

using properties::HlcpAnswer;
using properties::HlcpCase;
using properties::HlcpCheck;
using properties::Judgement;

/// A problem, what it is asked with, and how an answer to it fails.
struct Asked {
  const HlcpCase& problem;
  unsigned long long start;
  HlcpOptions options;

  /// The text is made only where it is wanted: it costs more than the solver.
  template <class... Values>
  void require(bool good, fmt::format_string<const Values&...> what, const Values&... values) const {
    if (good) return;
    fail(fmt::format("{}: {} from start {}, max_solves {}{}", fmt::format(what, values...), properties::json(problem),
                     start, options.max_solves,
                     options.not_unique == NotUnique::refuse ? "" : ", continue_along_signs"));
  }
};

bool all_finite(const HlcpCase& problem) {
  double sum = 0;
  for (int i = 0; i < problem.n; ++i) {
    for (int j = 0; j < problem.n; ++j) sum += 0 * problem.data.plus[i][j] + 0 * problem.data.minus[i][j];
    sum += 0 * problem.data.b[i];
  }
  return sum == 0;
}

/// Solved in room for `room` unknowns, order n. What a refusal must leave as it was is filled with what no answer has.
template <int room, class Count>
HlcpSolution<room> solve_in(const Hlcp<room>& data, Count n, const Asked& asked) {
  HlcpSolution<room> answer = {};
  for (int k = 0; k < room; ++k) {
    answer.x[k] = -0.0;
    answer.sign[k] = static_cast<signed char>((asked.start >> k & 1U) != 0 ? -1 : 1);
  }
  const HlcpSolution<room> before = answer;
  solve(data, n, answer, asked.options);
  asked.require(answer.status == Status::ok || (std::memcmp(answer.x, before.x, sizeof answer.x) == 0 &&
                                                std::memcmp(answer.sign, before.sign, sizeof answer.sign) == 0),
                "a refusal has changed x or sign");
  return answer;
}

HlcpAnswer answer_to(const Asked& asked) { return solve_in(asked.problem.data, asked.problem.n, asked); }

template <int a_room, int b_room>
bool same_bits(const HlcpSolution<a_room>& a, const HlcpSolution<b_room>& b, int n) {
  const auto size = static_cast<std::size_t>(n);
  return a.status == b.status && a.uniqueness == b.uniqueness &&
         (a.status != Status::ok ||
          (std::memcmp(a.x, b.x, sizeof(double) * size) == 0 && std::memcmp(a.sign, b.sign, size) == 0));
}

/// As an embedder has it: room for n, n known to the compiler.
template <int n>
void hold_in_own_room(const Asked& asked, const HlcpAnswer& answer) {
  if (asked.problem.n != n) return;
  Hlcp<n> data;
  for (int i = 0; i < n; ++i) {
    std::memcpy(data.plus[i], asked.problem.data.plus[i], sizeof data.plus[i]);
    std::memcpy(data.minus[i], asked.problem.data.minus[i], sizeof data.minus[i]);
  }
  std::memcpy(data.b, asked.problem.data.b, sizeof data.b);
  const HlcpSolution<n> other = solve_in(data, std::integral_constant<int, n>{}, asked);
  asked.require(same_bits(answer, other, n) && answer.solves == other.solves && answer.residual == other.residual,
                "another answer where the order is known to the compiler");
}

/// One of several, as asked for.
bool is_chosen(const HlcpAnswer& answer) {
  return answer.status == Status::ok && answer.uniqueness == Uniqueness::refuted;
}

/// The signs tried first change no bit of an answer up to order 4, or of a certified one; but of one that is chosen.
void hold_other_start(const Asked& asked, const HlcpAnswer& answer) {
  const HlcpAnswer other = answer_to({asked.problem, ~asked.start, asked.options});
  if (is_chosen(answer) || is_chosen(other)) return;
  const bool certified = answer.uniqueness == Uniqueness::certified && other.uniqueness == Uniqueness::certified;
  if (asked.problem.n > 4 && !certified) return;
  asked.require(same_bits(answer, other, asked.problem.n), "another answer from other signs");
}

/// Either of the two, by the first bit of `start` that is no sign: a second solve costs more than the exact solutions.
void hold_once_more(const Asked& asked, const HlcpAnswer& answer) {
  if (asked.problem.n > most_exact_order || (asked.start >> most_exact_order & 1U) != 0)
    return hold_other_start(asked, answer);
  hold_in_own_room<1>(asked, answer);
  hold_in_own_room<2>(asked, answer);
  hold_in_own_room<3>(asked, answer);
  hold_in_own_room<4>(asked, answer);
  hold_in_own_room<5>(asked, answer);
}

bool is_decided(Status status) {
  return status == Status::ok || status == Status::no_solution || status == Status::not_unique;
}

void hold_status(const Asked& asked, const HlcpAnswer& answer, Numbers numbers) {
  const Status status = answer.status;
  const bool decided = is_decided(status);
  const bool may_be = decided || status == Status::inaccurate || status == Status::singular_constraints ||
                      (status == Status::solve_limit && asked.problem.n > 4);
  asked.require(may_be, "status {} of finite data", name(status));
  if (asked.problem.n > 4 || numbers == Numbers::any) return;
  asked.require(asked.options.not_unique == NotUnique::refuse || status != Status::not_unique,
                "not_unique where one of several was asked for");
  asked.require(decided, "undecided: {}", name(status));
  asked.require(status != Status::ok || answer.uniqueness == Uniqueness::certified ||
                    answer.uniqueness == Uniqueness::single ||
                    (answer.uniqueness == Uniqueness::refuted && asked.options.not_unique != NotUnique::refuse),
                "undecided: {}", name(answer.uniqueness));
}

void hold_numbers(const Asked& asked, const HlcpAnswer& answer) {
  if (answer.status != Status::ok) return;
  const int n = asked.problem.n;
  asked.require(answer.residual >= 0 && answer.residual <= 4 * (n + 1) * 0x1p-53, "residual out of range");
  for (int k = 0; k < n; ++k) {
    const double x = answer.x[k];
    asked.require(std::isfinite(x) && (x != 0 || !std::signbit(x)), "x[{}] = {}", k, x);
    asked.require(answer.sign[k] == (x < 0 ? -1 : 1), "sign[{}] = {}, x = {}", k, answer.sign[k], x);
  }
}

void hold_truth(const Asked& asked, const HlcpAnswer& answer, Numbers numbers) {
  if (!is_decided(answer.status)) return;  // a refusal says nothing, and most extreme data, costly to judge, get one
  const HlcpCheck check = properties::check_hlcp(asked.problem, answer, properties::residual_promised(asked.problem.n),
                                                 oracle::Want::counts);
  // Above order 4 `unproven` promises what x misses and no more: rounding may hide that there is no solution.
  const bool weak = asked.problem.n > 4 && answer.uniqueness == Uniqueness::unproven && check.solved() &&
                    check.residual <= properties::residual_promised(asked.problem.n);
  asked.require(weak || check.judgement != Judgement::disagree, "{}", check.verdict);
  if (asked.problem.n > 4 || numbers == Numbers::any) return;
  asked.require((answer.uniqueness == Uniqueness::certified) == (check.solved() && check.exact->w_property),
                "certified by more or less than the W-property");
}

}  // namespace

void hold_hlcp(const HlcpCase& problem, unsigned long long start, HlcpOptions options, Numbers numbers) {
  const Asked asked{problem, start, options};
  const HlcpAnswer answer = answer_to(asked);
  hold_once_more(asked, answer);
  if (!all_finite(problem)) {
    return asked.require(answer.status == Status::invalid_input, "status {} of data that are not finite",
                         name(answer.status));
  }
  hold_status(asked, answer, numbers);
  hold_numbers(asked, answer);
  if (problem.n <= most_exact_order) hold_truth(asked, answer, numbers);
}

}  // namespace slideway::fuzz
