// What a claim of the kernel does where claims are checked.
#ifndef SLIDEWAY_VERIFY
#define SLIDEWAY_VERIFY
#endif
#include <gtest/gtest.h>

#include <slideway/hlcp_claims.hpp>
#include <slideway/verify.hpp>

using namespace slideway;

namespace {

TEST(AClaimDeathTest, ThatFailsEndsTheProgramWithItsPlace) {
  SLIDEWAY_CLAIM(2 + 2 == 4);
  EXPECT_DEATH(SLIDEWAY_CLAIM(2 + 2 == 5), "claims\\.cpp:[0-9]+: what should always hold does not: 2 \\+ 2 == 5");
}

TEST(Claims, OfSolvesAreNoWiderThanWhatASearchMakes) {
  using hlcp_detail::within_limit;
  EXPECT_TRUE(within_limit(0, 0, 100));
  EXPECT_FALSE(within_limit(1, 0, 100));
  EXPECT_TRUE(within_limit(6 + 6 + 8, 2, 0));  // two iterations, and each pattern twice
  EXPECT_FALSE(within_limit(6 + 6 + 8 + 1, 2, 0));
  EXPECT_TRUE(within_limit(101, 5, 100));
  EXPECT_FALSE(within_limit(102, 5, 100));
}

}  // namespace
