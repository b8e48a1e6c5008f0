// SPDX-License-Identifier: Apache-2.0
#include "kernel/isa.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace orrery::kernel {
namespace {

/// isa_name() asks an instance for the name it was compiled with. Highway's own record is reset by SupportedTargets().
TEST(KernelIsa, ALimitHoldsWhoeverElseAsksHighway) {
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
  EXPECT_EQ(isa_name(), available.back()) << "a name that is refused changes nothing";
  ASSERT_TRUE(limit_isa(""));
  EXPECT_EQ(isa_name(), available.front());
}

}  // namespace
}  // namespace orrery::kernel
