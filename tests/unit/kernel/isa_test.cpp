// SPDX-License-Identifier: Apache-2.0
#include "kernel/isa.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace orrery::kernel {
namespace {

/// isa_name() returns the target of the dispatched instance. SupportedTargets() resets Highway's own record.
TEST(KernelIsa, LimitSurvivesOtherUsesOfHighway) {
  const std::vector<std::string> available = available_isas();
  ASSERT_FALSE(available.empty());
  for (const std::string& isa : available) {
    ASSERT_TRUE(limit_isa(isa));
    EXPECT_EQ(isa_name(), isa);
    hwy::SupportedTargets();
    EXPECT_EQ(isa_name(), isa);
    EXPECT_EQ(available_isas(), available);
  }
  EXPECT_FALSE(limit_isa("mmx"));
  EXPECT_EQ(isa_name(), available.back()) << "a rejected name changes nothing";
  ASSERT_TRUE(limit_isa(""));
  EXPECT_EQ(isa_name(), available.front());
}

}  // namespace
}  // namespace orrery::kernel
