// SPDX-License-Identifier: Apache-2.0
#include "base/read_progress.h"

#include <gtest/gtest.h>

#include <memory>

namespace orrery::base {
namespace {

TEST(BaseReadProgress, IsThatOfTheInnermostScope) {
  const auto outer = std::make_shared<ReadProgress>(0), inner = std::make_shared<ReadProgress>(0);
  EXPECT_FALSE(ReadProgressScope::current());
  {
    const ReadProgressScope scope(outer);
    {
      const ReadProgressScope nested(inner);
      EXPECT_EQ(ReadProgressScope::current(), inner);
    }
    EXPECT_EQ(ReadProgressScope::current(), outer);
  }
  EXPECT_FALSE(ReadProgressScope::current());
}

}  // namespace
}  // namespace orrery::base
