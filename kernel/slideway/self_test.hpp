// A power-on self-test: do this processor, its settings and this program's memory do what the kernel was tested with?
//
// Everything is computed from numbers that the compiler does not know, and compared with results that are known to the
// last bit. What it cannot see: code that it does not run, such as that of a stepper of another scene. A controller
// that wants its own scene covered compares its own first steps with bits that it has stored.
#pragma once

#include <slideway/step.hpp>

namespace slideway {

/// What is damaged: the first that was found, causes before their consequences.
enum class SelfTest : unsigned char {
  passed,
  rounding,     ///< not to nearest, ties to even
  subnormals,   ///< flushed to zero, as results or as operands
  contraction,  ///< a b + c is rounded once: built without -ffp-contract=off, or with excess precision
  not_finite,   ///< infinity and NaN pass for numbers: built with -ffast-math or the like
  arithmetic,   ///< + - * / or sqrt
  functions,    ///< sin or cos, by more than an ulp
  tables,       ///< the coefficients of a method are not those that were compiled
  hlcp,         ///< the solver of contact forces
  stepping      ///< a step of a small mechanism, by one of the methods
};

constexpr const char* name(SelfTest result) noexcept {
  constexpr const char* names[] = {"passed",     "rounding",  "subnormals", "contraction", "not_finite",
                                   "arithmetic", "functions", "tables",     "hlcp",        "stepping"};
  const auto place = static_cast<unsigned>(result);
  return place < sizeof names / sizeof *names ? names[place] : "unknown";
}

namespace self_test_detail {

using hlcp_detail::bits;
using hlcp_detail::Word;

/// x, as the compiler does not know it.
inline double hidden(double x) noexcept {
  const volatile double hider = x;
  return hider;
}

/// One word of FNV-1a, 64 bits: (hash ^ word) prime is one to one in either, so damage to one word always shows.
constexpr Word fnv_start = 0xcbf29ce484222325;
constexpr Word mixed(Word hash, Word word) noexcept { return (hash ^ word) * 0x100000001b3; }

// --- settings and operations -----------------------------------------------------------------------------------------

/// Ties go to even: upwards, downwards and towards zero each fail one of these, as do ties away from zero.
inline bool rounds_to_nearest() noexcept {
  const double one = hidden(1), tie = hidden(0x1p-53);
  return one + tie == 1 && -one - tie == -1 && hidden(0x1.0000000000001p0) + tie == 0x1.0000000000002p0;
}

/// By bits: where operands are flushed, a subnormal compares equal to zero.
inline bool has_subnormals() noexcept {
  const double least = hidden(0x1p-1074);
  return bits(least + least) == 2 && bits(least * hidden(0x1p60)) == bits(0x1p-1014) &&
         bits(hidden(0x1p-1022) * hidden(0.5)) == bits(0x1p-1023) && bits(hidden(0x1p-1073) * hidden(0.75)) == 2;
}

/// (1 + e)(1 - e) - 1 = -e^2, but 0 if the product is rounded to a double.
inline bool rounds_products() noexcept {
  const double a = hidden(1 + 0x1p-30), b = hidden(1 - 0x1p-30), c = hidden(-1);
  return a * b + c == 0;
}

inline bool tells_what_is_finite() noexcept {
  const double most = hidden(0x1.fffffffffffffp1023), infinite = most * 2, not_a_number = infinite - infinite;
  return std::isfinite(most) && !std::isfinite(infinite) && !std::isfinite(not_a_number) && detail::finite(most) &&
         !detail::finite(infinite) && !detail::finite(not_a_number) && !(not_a_number == not_a_number) &&
         !(not_a_number > 0);
}

/// a, b, then a + b, a - b, a b, a / b and sqrt |a|, rounded once from the exact values.
inline constexpr double operations[][7] = {
    {0x1.921fb54442d18p1, 0x1.5bf0a8b145769p1, 0x1.77082efac424p2, 0x1.b1786497ead78p-2, 0x1.114580b45d474p3,
     0x1.27ddbf6271dbep0, 0x1.c5bf891b4ef6ap0},
    {0x1.5555555555555p-2, -0x1.6666666666666p-1, -0x1.7777777777777p-2, 0x1.0888888888888p0, -0x1.dddddddddddddp-3,
     -0x1.e79e79e79e79fp-2, 0x1.279a74590331cp-1},
    {0x1.4e718d7d7625ap664, 0x1.4ff632b6a83e4p-331, 0x1.4e718d7d7625ap664, 0x1.4e718d7d7625ap664, 0x1.b6e83b85f253bp333,
     0x1.fdafb60009ccfp994, 0x1.249ad2594c37dp332}};

inline bool calculates() noexcept {
  bool right = true;
  for (const auto& known : operations) {
    const double a = hidden(known[0]), b = hidden(known[1]);
    const double results[] = {a + b, a - b, a * b, a / b, std::sqrt(std::fabs(a))};
    for (int i = 0; i < 5; ++i) right = right && bits(results[i]) == bits(known[2 + i]);
  }
  return right;
}

/// Angle, cos, sin; 22 is near to 7 pi, 2^20 is many turns.
inline constexpr double turns[][3] = {{0x1p-1, 0x1.c1528065b7d5p-1, 0x1.eaee8744b05fp-2},
                                      {-0x1p1, -0x1.aa22657537205p-2, -0x1.d18f6ead1b446p-1},
                                      {0x1.6p4, -0x1.fffadd8d4acdap-1, -0x1.220a29f6eb9f4p-7},
                                      {0x1p20, 0x1.e33ada92fe2aep-1, 0x1.526ccb2fc8656p-2}};

/// C libraries differ in the last place: within an ulp, which is one step of the bits.
inline bool turns_rightly() noexcept {
  bool right = true;
  for (const auto& known : turns) {
    const Rotation turn = rotation(hidden(known[0]));
    right = right && bits(turn.c) - bits(known[1]) + 1 <= 2 && bits(turn.s) - bits(known[2]) + 1 <= 2;
  }
  return right;
}

// --- tables ----------------------------------------------------------------------------------------------------------

template <class Table>
struct Words {
  static_assert(sizeof(Table) % sizeof(Word) == 0, "a table is made of doubles");
  Word word[sizeof(Table) / sizeof(Word)];
};

template <class Table>
constexpr Word hash_of(const Table& table) noexcept {
  Word hash = fnv_start;
  for (const Word word : __builtin_bit_cast(Words<Table>, table).word) hash = mixed(hash, word);
  return hash;
}

/// The table in memory, against what the compiler made of it: that hash is part of an instruction.
template <const auto& table>
bool is_intact() noexcept {
  constexpr Word compiled = hash_of(table);
  const auto* volatile place = &table;
  return hash_of(*place) == compiled;
}

// --- contact forces --------------------------------------------------------------------------------------------------

/// x = (-1, 2, -3, 4, -5), the answer to all problems of pose().
constexpr int answer_of(int j) noexcept { return j % 2 != 0 ? j + 1 : -j - 1; }

/// W(s): all ones, and 4 for s = 1 or 2 for s = -1 more on the diagonal: symmetric and above 2 I, so that there is one
/// solution. All numbers are integers below 64.
inline void pose(int n, Hlcp<5>& problem) noexcept {
  for (int i = 0; i < n; ++i) {
    problem.b[i] = 0;
    for (int j = 0; j < n; ++j) {
      problem.plus[i][j] = hidden(i == j ? 5 : 1);
      problem.minus[i][j] = hidden(i == j ? 3 : 1);
      problem.b[i] += (answer_of(j) > 0 ? problem.plus : problem.minus)[i][j] * answer_of(j);
    }
  }
}

/// From equal signs, of which half are wrong. The equations' error is at most 5 (n + 1) 2^-53 of their terms, together
/// below 80; |W^-1| <= 1/2 brings x to within 30 x 80 x sqrt(5) / 2 x 2^-53 < 2^-41.
inline bool solves(int n, signed char sign) noexcept {
  Hlcp<5> problem = {};
  HlcpSolution<5> answer = {};
  pose(n, problem);
  for (signed char& first : answer.sign) first = sign;
  solve(problem, n, answer);
  bool right = answer.status == Status::ok && (answer.uniqueness == Uniqueness::certified || n > 4);
  for (int j = 0; j < n; ++j) right = right && std::fabs(answer.x[j] - answer_of(j)) <= 0x1p-41;
  return right;
}

/// With 2 x - 3|x| = b for the first of n: no solution for b = 1; two, x = 1 and x = -1/5, for b = -1.
inline Status status_of(int n, double b) noexcept {
  Hlcp<5> problem = {};
  HlcpSolution<5> answer = {};
  pose(n, problem);
  for (int j = 0; j < n; ++j) problem.plus[0][j] = problem.minus[0][j] = 0;
  problem.plus[0][0] = hidden(-1);
  problem.minus[0][0] = hidden(5);
  problem.b[0] = hidden(b);
  solve(problem, n, answer);
  return answer.status;
}

/// Above order 4 the solver does not decide how many solutions there are.
inline bool solves_all() noexcept {
  bool right = true;
  for (const int n : {1, 2, 3, 5}) right = right && solves(n, 1) && solves(n, -1);
  for (const int n : {1, 2, 3}) {
    right = right && status_of(n, 1) == Status::no_solution && status_of(n, -1) == Status::not_unique;
  }
  return right;
}

// --- stepping --------------------------------------------------------------------------------------------------------

/// A block on a driven belt, held back by a spring and damper: it slips, sticks after 0.02 s and breaks away after
/// 0.11 s. It is free to turn but does not: below 1e-12 rad every C library has cos = 1 and sin x = x.
constexpr Scene<Size<2, 4, 1, 2, 1, 0, 1, 0, 0, 0>> make_block_on_belt() noexcept {
  Scene<Size<2, 4, 1, 2, 1, 0, 1, 0, 0, 0>> scene;
  scene.gravity = {0, -8};
  scene.bodies = 2;
  scene.body[0].joint = Joint::prismatic;
  scene.body[0].mass = 1;
  scene.body[0].v[0] = 0.5;
  Body& block = scene.body[1];
  block.joint = Joint::planar;
  block.mass = 1;
  block.com = {0, 0.0625};
  block.inertia = 0.015625;
  block.q[0] = -0.03125;
  block.v[0] = 0.4375;
  scene.guides = 1;
  Guide& feet = scene.guide[0];
  feet.slider = 1;
  feet.rail = 0;
  feet.contacts = 2;
  feet.contact[0] = {-0.125, 0};
  feet.contact[1] = {0.125, 0};
  feet.mu = 0.125;
  feet.mu_static = 0.25;
  feet.viscous = 0.25;
  scene.drives = 1;
  scene.drive[0].c[1] = 0.5;
  scene.springs = 1;
  scene.spring[0].a = 1;
  scene.spring[0].b_at = {-1, 0};
  scene.spring[0].stiffness = 64;
  scene.spring[0].length = 1;
  scene.spring[0].damping = 0.5;
  return scene;
}
inline constexpr auto block_on_belt = make_block_on_belt();

/// Steps of 1/16 s from the start: the bits of all states and energies, all modes, signs and numbers of events. Zero
/// when a step is refused.
[[gnu::noinline]] inline Word hash_of_steps(Method method, int steps) noexcept {
  Stepper<block_on_belt> stepper;
  stepper.method = method;
  auto state = stepper.start();
  for (double& x : state.q) x = hidden(x);
  Word hash = fnv_start;
  for (int k = 0; k < steps; ++k) {
    const Report report = stepper.step(state, hidden(0.0625));
    if (report.status != Status::ok) return 0;
    for (const double q : state.q) hash = mixed(hash, bits(q));
    for (const double v : state.v) hash = mixed(hash, bits(v));
    for (const double energy : {report.energy.work, report.energy.dissipated, report.energy.constraint_work}) {
      hash = mixed(hash, bits(energy));
    }
    for (const int number : {+state.mode[0], +state.sign[0], +state.sign[1], report.events, report.unlocated_events}) {
      hash = mixed(hash, static_cast<Word>(number));
    }
  }
  return hash;
}

struct Known {
  Method method;
  Word hash;
};

/// What `self_test --golden` prints (tests/embedded/self_test.cpp): after a change of the kernel's arithmetic, anew.
inline constexpr int golden_steps = 12;
inline constexpr Known golden[] = {{Method::rk4, 0xb43c5082560f52dd},
                                   {Method::rk4_located, 0x8d9377d3f083c668},
                                   {Method::dop853_located, 0xc6494779c1007c3a},
                                   {Method::moreau, 0x2fce3a566174dc38}};

inline bool steps_rightly() noexcept {
  bool right = true;
  const int steps = static_cast<int>(hidden(golden_steps));
  for (const Known& known : golden) right = right && hash_of_steps(known.method, steps) == known.hash;
  return right;
}

}  // namespace self_test_detail

/// Tests everything above once: no argument, no state, the same stack as a step of a small scene. Some hundred
/// microseconds on a desktop processor (bench/step). Sets the sticky flags of floating-point exceptions.
[[gnu::noinline]] inline SelfTest self_test() noexcept {
  namespace tests = self_test_detail;
  if (!tests::rounds_to_nearest()) return SelfTest::rounding;
  if (!tests::has_subnormals()) return SelfTest::subnormals;
  if (!tests::rounds_products()) return SelfTest::contraction;
  if (!tests::tells_what_is_finite()) return SelfTest::not_finite;
  if (!tests::calculates()) return SelfTest::arithmetic;
  if (!tests::turns_rightly()) return SelfTest::functions;
  if (!tests::is_intact<runge_kutta_4>() || !tests::is_intact<dormand_prince_8>()) return SelfTest::tables;
  if (!tests::solves_all()) return SelfTest::hlcp;
  return tests::steps_rightly() ? SelfTest::passed : SelfTest::stepping;
}

}  // namespace slideway
