// SPDX-License-Identifier: Apache-2.0
#include "math/pixels.h"

#include <gtest/gtest.h>

namespace orrery::math {
namespace {

TEST(MathPixels, PixelsAreCountedBeyondTheRangeOfInt) {
  EXPECT_EQ(pixel_count(70000, 50000), 3500000000u);
  EXPECT_EQ(pixel_count(0, 7), 0u);
}

TEST(MathPixels, IndicesAreInRowMajorOrder) {
  EXPECT_EQ(pixel_index(2, 0, 5), 2u);
  EXPECT_EQ(pixel_index(2, 3, 5), 17u);
  EXPECT_EQ(pixel_index(69999, 49999, 70000) + 1, pixel_count(70000, 50000));
}

}  // namespace
}  // namespace orrery::math
