// What a claim of the kernel does where claims are checked.
#ifndef SLIDEWAY_VERIFY
#define SLIDEWAY_VERIFY
#endif
#include <gtest/gtest.h>

#include <slideway/verify.hpp>

namespace {

TEST(AClaimDeathTest, ThatFailsEndsTheProgramWithItsPlace) {
  SLIDEWAY_CLAIM(2 + 2 == 4);
  EXPECT_DEATH(SLIDEWAY_CLAIM(2 + 2 == 5), "claims\\.cpp:[0-9]+: what should always hold does not: 2 \\+ 2 == 5");
}

}  // namespace
