// Every problem of a small world: all HLCPs with entries of {-1, 0, 1} of order 1 and 2, all LCPs of order 3. Answer,
// solution and uniqueness are the exact ones; nothing is left undecided.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <slideway/properties/hlcp.hpp>

namespace {

using namespace slideway;
using namespace slideway::properties;
using oracle::Count;

/// What the kernel has to say, in words.
std::string expected(const oracle::ExactAnswer& exact) {
  switch (exact.count()) {
    case Count::none:
      return "no solution";
    case Count::one:
      return exact.w_property ? "one solution, W-property" : "one solution";
    case Count::several:
      return "several solutions";
    case Count::continuum:
      break;
  }
  return "a continuum of solutions";
}

/// What it says. The kernel makes no difference between several and infinitely many.
bool says(const HlcpAnswer& answer, const std::string& what) {
  if (what == "no solution") return answer.status == Status::no_solution;
  if (what == "one solution") return answer.status == Status::ok && answer.uniqueness == Uniqueness::single;
  if (what == "one solution, W-property") {
    return answer.status == Status::ok && answer.uniqueness == Uniqueness::certified;
  }
  return answer.status == Status::not_unique;
}

void hold_all(int n, bool is_lcp) {
  std::map<std::string, int> counts;
  const unsigned long long all = small_hlcps(n, is_lcp);
  double worst = 0;
  for (unsigned long long code = 0; code < all; ++code) {
    const HlcpCase problem = small_hlcp(n, code, is_lcp);
    // Every problem from another start.
    const HlcpCheck check = check_hlcp(problem, kernel_answer(problem, code));
    const std::string what = expected(*check.exact);
    ++counts[what];
    ASSERT_TRUE(check.agree() && says(check.answer, what))
        << "problem " << code << ": " << json(problem) << "\n"
        << name(check.answer.status) << ", " << name(check.answer.uniqueness) << ", " << check.verdict;
    // Solutions are quotients of integers below 2^6: a few roundings of them.
    if (check.solved()) worst = std::fmax(worst, check.distance);
  }
  EXPECT_LE(worst, 8 * 0x1p-52) << "of the solution, relative";
  std::printf("order %d, %s: %llu problems\n", n, is_lcp ? "LCP" : "HLCP", all);
  for (const auto& [what, count] : counts) {
    std::printf("  %8d  %s\n", count, what.c_str());
    testing::Test::RecordProperty(what, count);
  }
}

TEST(SmallWorld, OfHlcpsOfOrderOneIsDecided) { hold_all(1, false); }
TEST(SmallWorld, OfHlcpsOfOrderTwoIsDecided) { hold_all(2, false); }
TEST(SmallWorld, OfLcpsOfOrderThreeIsDecided) { hold_all(3, true); }

}  // namespace
