// SPDX-License-Identifier: Apache-2.0
#include "base/huge_pages.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace orrery::base {
namespace {

TEST(BaseHugePages, TakesAsManyBytesAsTheLargestValueNeeds) {
  const auto bytes_of_hundred = [](std::uint32_t largest) { return PackedArray(100, largest).bytes(); };
  EXPECT_EQ(bytes_of_hundred(255), 103u);
  EXPECT_EQ(bytes_of_hundred(256), 202u);
  EXPECT_EQ(bytes_of_hundred(65535), 202u);
  EXPECT_EQ(bytes_of_hundred(65536), 301u);
  EXPECT_EQ(bytes_of_hundred(0xFFFFFF), 301u);
  EXPECT_EQ(bytes_of_hundred(0x1000000), 400u);
  EXPECT_EQ(bytes_of_hundred(0xFFFFFFFF), 400u);
}

TEST(BaseHugePages, HoldsEveryValueWithoutTouchingItsNeighbours) {
  std::mt19937 random(1);
  for (const std::uint32_t largest : {0u, 200u, 255u, 256u, 65535u, 70'000u, 0xFFFFFFu, 0x1000000u, 0xFFFFFFFFu}) {
    PackedArray packed(1000, largest);
    std::vector<std::uint32_t> expected(1000, largest);
    for (int change = 0; change < 3000; ++change) {
      const std::size_t i = random() % expected.size();
      const auto value = std::uniform_int_distribution<std::uint32_t>(0, largest)(random);
      packed.set(i, value);
      expected[i] = value;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(packed[i], expected[i]) << largest << " at " << i;
  }
}

TEST(BaseHugePages, MayBeEmpty) {
  EXPECT_EQ(PackedArray().size(), 0u);
  EXPECT_EQ(PackedArray(0, 7).size(), 0u);
}

}  // namespace
}  // namespace orrery::base
