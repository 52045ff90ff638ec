// What follows when the signs tried first do not settle a problem: scaling, iteration over sign patterns, exact
// decision, enumeration.
#pragma once

#include <slideway/hlcp_decide.hpp>
#include <slideway/hlcp_unique.hpp>

namespace slideway::hlcp_detail {

template <int Capacity>
inline void report(HlcpSolution<Capacity>& solution, Status status, Uniqueness uniqueness, int solves, double residual,
                   bool bounded = false) noexcept {
  solution.status = status;
  solution.uniqueness = uniqueness;
  solution.solves = solves;
  solution.residual = residual;
  solution.bounded = bounded;
}

template <int Capacity>
inline void refuse(HlcpSolution<Capacity>& solution, Status status, int solves) noexcept {
  report(solution, status, status == Status::not_unique ? Uniqueness::refuted : Uniqueness::unproven, solves, 0.0);
}

template <int Capacity>
inline void accept(HlcpSolution<Capacity>& solution, int n, const double* x, Uniqueness uniqueness, int solves,
                   double residual) noexcept {
  for (int k = 0; k < n; ++k) {
    solution.x[k] = x[k] + 0.0;  // -0 becomes 0
    solution.sign[k] = static_cast<signed char>(x[k] < 0.0 ? -1 : 1);
  }
  report(solution, Status::ok, uniqueness, solves, residual);
}

/// Every row and the right side brought to about 1 by powers of two; x of the scaled problem times 2^exponent is the
/// answer.
template <int Capacity>
struct Scaled {
  Hlcp<Capacity> problem;
  int exponent;
  bool lost;    ///< an entry below 2^-1022 of its row or of b was rounded, but none to zero
  bool finite;  ///< all data are
};

inline int exponent_of(double value) noexcept {
  const int field = static_cast<int>((bits(value) >> 52) & 2047);
  return field != 0 ? field - 1023 : static_cast<int>((bits(value * 0x1p64) >> 52) & 2047) - 1023 - 64;
}

/// value * 2^k, |k| <= 3000.
inline double times_power(double value, int k) noexcept {
  for (int step = 0; step < 3; ++step) {
    const int part = k > 1000 ? 1000 : (k < -1000 ? -1000 : k);
    value *= power_of_two(part);
    k -= part;
  }
  return value;
}

/// value * 2^k; where that is too small to be exact, a neighbour of it that is not zero, and `lost`.
inline double scaled_by(double value, int k, bool& lost) noexcept {
  const double scaled = times_power(value, k);
  if (times_power(scaled, -k) == value) return scaled;
  lost = true;
  return scaled != 0.0 ? scaled : std::copysign(0x1p-1074, value);
}

template <int Capacity>
inline void scale(const Hlcp<Capacity>& given, int n, Scaled<Capacity>& scaled) noexcept {
  constexpr int none = -5000;
  int row_exponent[Capacity];
  scaled.exponent = none;
  scaled.lost = false;
  scaled.finite = true;
  for (int i = 0; i < n; ++i) {
    double largest = 0.0;
    bool finite = std::isfinite(given.b[i]);
    for (int j = 0; j < n; ++j) {
      finite = finite && std::isfinite(given.plus[i][j]) && std::isfinite(given.minus[i][j]);
      largest = larger(largest, larger(std::fabs(given.plus[i][j]), std::fabs(given.minus[i][j])));
    }
    scaled.finite = scaled.finite && finite;
    row_exponent[i] = largest > 0.0 ? exponent_of(largest) : 0;
    const int relative = given.b[i] != 0.0 ? exponent_of(given.b[i]) - row_exponent[i] : none;
    scaled.exponent = relative > scaled.exponent ? relative : scaled.exponent;
  }
  if (scaled.exponent == none) scaled.exponent = 0;
  for (int i = 0; i < n; ++i) {
    const int down = -row_exponent[i];
    for (int j = 0; j < n; ++j) {
      scaled.problem.plus[i][j] = scaled_by(given.plus[i][j], down, scaled.lost);
      scaled.problem.minus[i][j] = scaled_by(given.minus[i][j], down, scaled.lost);
    }
    scaled.problem.b[i] = scaled_by(given.b[i], down - scaled.exponent, scaled.lost);
  }
}

/// The state of a search over sign patterns: a scaled problem of order n, and what it has cost.
template <int Capacity>
struct Search {
  Scaled<Capacity> scaled;
  Trial<Capacity> trial;
  int n;
  int solves;
  int max_solves;
};

template <int Capacity>
inline bool try_signs(Search<Capacity>& search, const signed char* signs) noexcept {
  ++search.solves;
  return attempt(search.scaled.problem, search.n, signs, search.trial);
}

/// Sets to zero the components of x that are not of the sign sigma in {-1, 0, 1}; whether the residual allows it. If
/// not, once more after two steps of refinement: what then contradicts is within 2^-52 max|x| of zero.
template <int Capacity>
inline bool enforce(Search<Capacity>& search, const signed char* sigma) noexcept {
  Trial<Capacity>& trial = search.trial;
  for (int round = 0; round < 2; ++round) {
    double kept[Capacity];
    std::memcpy(kept, trial.x, sizeof kept);
    for (int k = 0; k < search.n; ++k)
      if (!(sigma[k] * kept[k] > 0.0)) trial.x[k] = 0.0;
    check(search.scaled.problem, search.n, trial);
    if (trial.accurate) return true;
    std::memcpy(trial.x, kept, sizeof kept);
    for (int step = 0; step < 2 && round == 0; ++step) refine(search.scaled.problem, search.n, trial);
  }
  return false;
}

/// Whether x has the signs, up to components below tie_window of the largest that contradict by rounding: these become
/// zero.
template <int Capacity>
inline bool settle(Search<Capacity>& search, const signed char* signs) noexcept {
  const Trial<Capacity>& trial = search.trial;
  double largest = 0.0;
  bool same = true;
  for (int k = 0; k < search.n; ++k) largest = larger(largest, std::fabs(trial.x[k]));
  for (int k = 0; k < search.n; ++k) {
    const double along = signs[k] * trial.x[k];
    if (along < -tie_window * largest) return false;
    same = same && along >= 0.0;
  }
  return same || enforce(search, signs);
}

/// The signs of x; of a zero, the one it had.
template <class Count>
inline void take_signs(const double* x, Count n, signed char* signs) noexcept {
  for (int k = 0; k < n; ++k) {
    if (x[k] < 0.0) signs[k] = -1;
    if (x[k] > 0.0) signs[k] = 1;
  }
}

static_assert(hlcp_max_order <= 64, "a bit of a word for each sign");

inline Word code_of(const signed char* signs, int n) noexcept {
  Word code = 0;
  for (int k = 0; k < n; ++k) code |= static_cast<Word>(signs[k] == -1) << k;
  return code;
}

inline void signs_of(Word code, int n, signed char* signs) noexcept {
  SLIDEWAY_CLAIM(n == 64 || code >> n == 0);
  for (int k = 0; k < n; ++k) signs[k] = static_cast<signed char>(((code >> k) & 1) != 0 ? -1 : 1);
}

enum class Found : unsigned char { solution, nothing, limit };

/// Sign iteration (generalized Newton, Mangasarian 2009): the signs of W(s)^-1 b are the next s. At most n + 4 solves;
/// gives up on a pattern seen before.
template <int Capacity>
inline Found iterate_signs(Search<Capacity>& search, signed char* signs) noexcept {
  Word seen[Capacity + 4];
  for (int step = 0; step < search.n + 4; ++step) {
    if (search.solves >= search.max_solves) return Found::limit;
    seen[step] = code_of(signs, search.n);
    for (int k = 0; k < step; ++k)
      if (seen[k] == seen[step]) return Found::nothing;
    const bool accurate = try_signs(search, signs);
    if (!search.trial.regular) return Found::nothing;
    signed char next[hlcp_max_order];
    std::memcpy(next, signs, sizeof next);
    take_signs(search.trial.x, search.n, next);
    if (accurate && settle(search, signs)) return Found::solution;
    std::memcpy(signs, next, sizeof next);
  }
  return Found::nothing;
}

/// Flips the least index whose sign is wrong. With the W-property index k (of 0..n-1) flips at most 2^(n-1-k) times
/// (Rohn 2009), 2^n - 1 flips in all; more flips, or a singular matrix, mean that the property does not hold (or
/// rounding), and it gives up.
template <int Capacity>
inline Found flip_least(Search<Capacity>& search, signed char* signs) noexcept {
  const int n = search.n;
  Word flips[Capacity] = {};
  while (search.solves < search.max_solves) {
    const bool accurate = try_signs(search, signs);
    if (!search.trial.regular) return Found::nothing;
    double x[Capacity];
    std::memcpy(x, search.trial.x, sizeof x);
    if (accurate && settle(search, signs)) return Found::solution;
    int least = 0;
    while (least < n && !(signs[least] * x[least] < 0.0)) ++least;
    if (least == n || ++flips[least] > (Word{1} << (n - 1 - least))) return Found::nothing;
    signs[least] = static_cast<signed char>(-signs[least]);
  }
  return Found::limit;
}

template <int Capacity>
inline Found find(Search<Capacity>& search, signed char* signs) noexcept {
  const Found found = iterate_signs(search, signs);
  return found == Found::nothing ? flip_least(search, signs) : found;
}

/// Hands out the trial's x, unscaled; refuses what does not fit into normal numbers.
template <int Capacity>
inline void deliver(const Search<Capacity>& search, Uniqueness uniqueness, HlcpSolution<Capacity>& solution) noexcept {
  double x[Capacity] = {};
  bool good = true;
  for (int k = 0; k < search.n; ++k) {
    const double scaled = search.trial.x[k];
    x[k] = times_power(scaled, search.scaled.exponent);
    const double size = std::fabs(x[k]);
    good = good && (scaled == 0.0 || (size >= 0x1p-1022 && size < HUGE_VAL));
    // A rounded entry is off by 2^-1074 at most: no harm below 2^100 beside the terms of its row, of 2^-900 (check();
    // a row that vanishes there vanishes in the problem given, since nothing was rounded to zero).
    good = good && !(search.scaled.lost && std::fabs(scaled) > 0x1p100);
  }
  if (!good) return refuse(solution, Status::inaccurate, search.solves);
  accept(solution, search.n, x, uniqueness, search.solves, search.trial.residual);
}

inline bool in_exact_range(double value) noexcept { return value == 0.0 || std::fabs(value) >= 0x1p-180; }

/// The trial of the first pattern with the signs sigma, + before - for its zeros, that solves the problem. All of them
/// can be singular, as for |x1| + |x2| = 0: then the columns of sigma alone determine x.
template <int Capacity, int Order>
inline Status finish(Search<Capacity>& search, const Decided<Order>& decided) noexcept {
  Trial<Capacity>& trial = search.trial;
  signed char signs[hlcp_max_order];
  bool regular = false;
  for (Word code = 0; code < (Word{1} << search.n); ++code) {
    signs_of(code, search.n, signs);
    if (!compatible(signs, decided.sigma, search.n)) continue;
    try_signs(search, signs);
    regular = regular || trial.regular;
    if (trial.regular && enforce(search, decided.sigma)) return Status::ok;
  }
  if (decided.frail) return regular ? Status::inaccurate : Status::singular_constraints;
  for (int k = 0; k < Order; ++k)  // a sign is exact, the rounded minor beside it may have the other
    trial.x[k] = decided.sigma[k] * decided.x[k] > 0.0 ? decided.x[k] : 0.0;
  if constexpr (Order % 2 != 0) trial.x[Order] = 0.0;  // the odd one out, which no solve has set
  check(search.scaled.problem, search.n, trial);
  return trial.accurate ? Status::ok : Status::inaccurate;
}

/// The order is at most 4: the exact decision, then the trial of the signs that it found.
template <int Capacity>
inline void decide_small(Search<Capacity>& search, const signed char* first, const signed char* second,
                         NotUnique policy, HlcpSolution<Capacity>& solution) noexcept {
  const Hlcp<Capacity>& problem = search.scaled.problem;
  const int n = search.n;
  constexpr int order = Capacity < decidable ? Capacity : decidable;
  Small<order> small = {{}, {}, {}, n, !search.scaled.lost};
  for (int i = 0; i < n; ++i) {
    small.b[i] = problem.b[i];
    small.within_range = small.within_range && in_exact_range(small.b[i]);
    for (int j = 0; j < n; ++j) {
      small.plus[i][j] = problem.plus[i][j];
      small.minus[i][j] = problem.minus[i][j];
      small.within_range = small.within_range && in_exact_range(small.plus[i][j]) && in_exact_range(small.minus[i][j]);
    }
  }
  const Decided<order> decided = decide(small, first, second);
  search.solves += decided.determinants;
  const bool several = decided.decision == Decision::several;
  if (decided.decision == Decision::none) return refuse(solution, Status::no_solution, search.solves);
  if (decided.decision == Decision::doubtful) return refuse(solution, Status::singular_constraints, search.solves);
  if (decided.decision == Decision::hidden) return refuse(solution, Status::inaccurate, search.solves);
  if (several && policy == NotUnique::refuse) return refuse(solution, Status::not_unique, search.solves);
  const Status status = finish(search, decided);
  if (status != Status::ok) return refuse(solution, several ? Status::not_unique : status, search.solves);
  deliver(search,
          several                                   ? Uniqueness::refuted
          : decided.decision == Decision::certified ? Uniqueness::certified
                                                    : Uniqueness::single,
          solution);
}

/// What enumeration of all sign patterns has seen.
struct Census {
  signed char sign[hlcp_max_order];  ///< the first pattern whose x is a solution, a proven one if there is one
  bool found;                        ///< there is such a pattern
  int proven;     ///< patterns that certainly have a solution with no zero in it: all of these differ
  bool doubtful;  ///< some pattern is neither proven nor excluded beyond rounding errors
};

/// A bound on |x - W^-1 b| in the largest component; infinite where W may be singular. |x - W^-1 b| <= |W^-1| r for the
/// residual r allowed, and |W^-1| r is at most twice its bound from L and U if their errors cannot make W singular.
/// Entries that scale() has rounded are none of these errors.
template <int Capacity>
inline double error_of(const Search<Capacity>& search) noexcept {
  const Trial<Capacity>& trial = search.trial;
  const Hlcp<Capacity>& problem = search.scaled.problem;
  const int n = search.n;
  double r[Capacity] = {};
  double z[Capacity];
  if (search.scaled.lost || !(lu_error(trial, n) * reach_of(trial, n, trial.size, z) <= 0.5)) return HUGE_VAL;
  for (int i = 0; i < n; ++i) {
    r[i] = std::fabs(problem.b[i]);
    for (int j = 0; j < n; ++j) r[i] += std::fabs(trial.w[i][j] * trial.x[j]);
    r[i] *= 2.0 * residual_limit(n);
  }
  return 2.0 * reach_of(trial, n, r, z);
}

/// Enters the pattern just tried. It has a solution if all components of W^-1 b have its signs, and none if one has
/// not.
template <int Capacity>
inline void enter(Search<Capacity>& search, const signed char* signs, bool accurate, Census& census) noexcept {
  const double error = accurate ? error_of(search) : HUGE_VAL;
  bool proven = true;
  bool excluded = false;
  for (int k = 0; k < search.n && accurate; ++k) {
    const double along = signs[k] * search.trial.x[k];
    proven = proven && along > error;
    excluded = excluded || along < -error;
  }
  proven = proven && accurate;
  census.doubtful = census.doubtful || !(proven || excluded);
  if (proven ? census.proven == 0 : !census.found && !excluded && accurate && settle(search, signs)) {
    std::memcpy(census.sign, signs, sizeof census.sign);
    census.found = true;
  }
  census.proven += proven ? 1 : 0;
}

/// All 2^n sign patterns, as far as max_solves goes: for problems that the iterations could not solve, n > 4.
template <int Capacity>
inline void enumerate(Search<Capacity>& search, NotUnique policy, HlcpSolution<Capacity>& solution) noexcept {
  Census census = {};
  signed char signs[hlcp_max_order] = {};
  const Word last = ~Word{0} >> (64 - search.n);  // no 2^n to count to: for n = 64 there is none
  bool complete = false;
  for (Word code = 0; !complete && census.proven < 2 && search.solves < search.max_solves; ++code) {
    SLIDEWAY_CLAIM(code <= last);  // no pattern twice
    signs_of(code, search.n, signs);
    const bool accurate = try_signs(search, signs);
    enter(search, signs, accurate, census);
    complete = code == last;
  }
  if (!census.found)
    return refuse(solution,
                  !complete         ? Status::solve_limit
                  : census.doubtful ? Status::singular_constraints
                                    : Status::no_solution,
                  search.solves);
  if (census.proven == 2 && policy == NotUnique::refuse) return refuse(solution, Status::not_unique, search.solves);
  if (!try_signs(search, census.sign) || !settle(search, census.sign))
    return refuse(solution, Status::inaccurate, search.solves);
  deliver(search,
          census.proven == 2             ? Uniqueness::refuted
          : complete && !census.doubtful ? Uniqueness::single
                                         : Uniqueness::unproven,
          solution);
}

/// Signs to start from again: + for what is within `window` of zero, relative to the largest, else those given.
template <int Capacity>
inline void without_ties(const Search<Capacity>& search, const signed char* signs, double window,
                         signed char* start) noexcept {
  double largest = 0.0;
  for (int k = 0; k < search.n; ++k) largest = larger(largest, std::fabs(search.trial.x[k]));
  for (int k = 0; k < search.n; ++k)
    start[k] = std::fabs(search.trial.x[k]) <= window * largest ? static_cast<signed char>(1) : signs[k];
}

/// The order is above 4: iterations from the signs given; enumeration if they fail. Near a tie several patterns may be
/// of one solution, each with its own rounding: what is certified is then found from + for all signs.
template <int Capacity>
inline void search_large(Search<Capacity>& search, signed char* signs, NotUnique policy,
                         HlcpSolution<Capacity>& solution) noexcept {
  const Hlcp<Capacity>& problem = search.scaled.problem;
  for (int i = 0; i < search.n; ++i) {
    bool zero = true;
    for (int j = 0; j < search.n; ++j) zero = zero && problem.plus[i][j] == 0.0 && problem.minus[i][j] == 0.0;
    if (zero)
      return refuse(solution, problem.b[i] != 0.0 ? Status::no_solution : Status::singular_constraints, search.solves);
  }
  Found found = find(search, signs);
  if (found == Found::nothing) return enumerate(search, policy, solution);
  bool proven = found == Found::solution && contracts(problem, search.n, search.trial);
  const bool tie = found == Found::solution && !clear(search.trial.x, search.n, signs);
  signed char start[hlcp_max_order];
  if (tie && !proven) {
    without_ties(search, signs, tie_window, start);
    found = find(search, start);
    if (found == Found::nothing) found = find(search, signs);
    proven = found == Found::solution && contracts(problem, search.n, search.trial);
  }
  if (tie && proven) {
    without_ties(search, signs, 1.0, start);
    found = find(search, start);
    proven = found == Found::solution;
    if (found == Found::nothing) found = find(search, signs);
  }
  if (found == Found::limit) return refuse(solution, Status::solve_limit, search.solves);
  if (found == Found::nothing) return refuse(solution, Status::inaccurate, search.solves);
  deliver(search, proven ? Uniqueness::certified : Uniqueness::unproven, solution);
}

/// Everything that one solve with the signs given does not settle.
template <int Capacity>
[[gnu::noinline, gnu::cold]] void solve_with_care(const Hlcp<Capacity>& given, int n, HlcpSolution<Capacity>& solution,
                                                  HlcpOptions options, int solves) noexcept {
  Search<Capacity> search;
  search.n = n;
  search.solves = solves;
  search.max_solves = options.max_solves;
  scale(given, n, search.scaled);
  if (!search.scaled.finite) return refuse(solution, Status::invalid_input, solves);
  signed char first[hlcp_max_order];
  signed char signs[hlcp_max_order];
  const Word code = code_of(solution.sign, n);
  signs_of(code, n, first);
  signs_of(code, n, signs);
  if constexpr (Capacity > decidable)
    if (n > decidable) return search_large(search, signs, options.not_unique, solution);
  if constexpr (Capacity > 2) {
    const bool found = n > 2 && iterate_signs(search, signs) == Found::solution;
    if (found && clear(search.trial.x, n, signs) && proves(search.scaled.problem, n, search.trial))
      return deliver(search, Uniqueness::certified, solution);
  }
  decide_small(search, first, signs, options.not_unique, solution);
}

}  // namespace slideway::hlcp_detail
