// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

namespace orrery::base {
namespace {

// Users' scripts depend on these numbers.
TEST(BaseError, EachKindHasItsDocumentedNumber) {
  EXPECT_EQ(exit_status(ErrorKind::kInternal), 70);
  EXPECT_EQ(exit_status(ErrorKind::kNoMemory), 71);
  EXPECT_EQ(exit_status(ErrorKind::kUsage), 2);
  EXPECT_EQ(exit_status(ErrorKind::kBadData), 65);
  EXPECT_EQ(exit_status(ErrorKind::kMissingInput), 66);
  EXPECT_EQ(exit_status(ErrorKind::kCannotCreate), 73);
  EXPECT_EQ(exit_status(ErrorKind::kIo), 74);
  EXPECT_EQ(exit_status(ErrorKind::kStopped), 75);
}

}  // namespace
}  // namespace orrery::base
