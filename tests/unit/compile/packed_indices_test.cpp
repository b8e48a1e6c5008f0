// SPDX-License-Identifier: Apache-2.0
#include "compile/packed_indices.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace orrery::compile {
namespace {

constexpr std::size_t kPadding = 3;

PackedIndices packed(const std::vector<std::uint32_t>& indices) {
  PackedIndices out;
  for (const std::uint32_t i : indices) out.push_back(i);
  return out;
}

TEST(CompilePackedIndices, EqualIndicesTakeNoBytesEach) {
  for (const std::uint32_t index : {0u, 7u, 70'000u, 0xffffffffu}) {
    const PackedIndices indices = packed(std::vector<std::uint32_t>(1000, index));
    EXPECT_EQ(indices.size(), 1000u);
    EXPECT_EQ(indices.bytes(), 4u);
    EXPECT_EQ(indices[999], index);
  }
}

TEST(CompilePackedIndices, OthersTakeAsManyAsTheLargest) {
  EXPECT_EQ(packed({0, 255, 3}).bytes(), 3 + kPadding);
  EXPECT_EQ(packed({0, 256, 3}).bytes(), 6 + kPadding);
  EXPECT_EQ(packed({65'535, 0}).bytes(), 4 + kPadding) << "the first is the largest";
  EXPECT_EQ(packed({0, 65'536}).bytes(), 8 + kPadding);
  EXPECT_EQ(packed({0xffffffffu, 0}).bytes(), 8 + kPadding);
}

TEST(CompilePackedIndices, WideningKeepsThem) {
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    std::vector<std::uint32_t> want;
    PackedIndices indices;
    for (int i = 0; i < 300; ++i) {
      want.push_back(static_cast<std::uint32_t>(random() >> (8 + random() % 24)));
      if (i % 100 == 99) want.back() = static_cast<std::uint32_t>(random());
      indices.push_back(want.back());
    }
    for (std::size_t i = 0; i < want.size(); ++i) ASSERT_EQ(indices[i], want[i]) << run << ' ' << i;
  }
}

}  // namespace
}  // namespace orrery::compile
