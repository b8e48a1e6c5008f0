// SPDX-License-Identifier: Apache-2.0
#include "math/dispatch.h"

#include <gtest/gtest.h>

namespace orrery::math {
namespace {

TEST(MathDispatch, TargetsAreLimitedToAvailableOnes) {
  TargetChoice choice;
  ASSERT_NE(choice.available(), 0);
  EXPECT_EQ(choice.enabled(), choice.available());
  const std::int64_t one = choice.available() & -choice.available();
  choice.limit(one);
  EXPECT_EQ(choice.enabled(), one);
  choice.limit(~choice.available());
  EXPECT_EQ(choice.enabled(), 0) << "what the processor lacks cannot be enabled";
  choice.limit(-1);
  EXPECT_EQ(choice.enabled(), choice.available()) << "a limit can be lifted";
}

TEST(MathDispatch, TheProcessHasOneChoice) { EXPECT_EQ(&target_choice(), &target_choice()); }

}  // namespace
}  // namespace orrery::math
