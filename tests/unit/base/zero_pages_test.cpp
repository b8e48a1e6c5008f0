// SPDX-License-Identifier: Apache-2.0
#include "base/zero_pages.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/peak_memory.h"

namespace orrery::base {
namespace {

TEST(BaseZeroPages, ElementsAreZero) {
  for (const std::size_t count : {0u, 3u, 1u << 21}) {
    ZeroVector<std::uint32_t> v;
    v.resize(count);
    EXPECT_EQ(std::count(v.begin(), v.end(), 0u), static_cast<std::ptrdiff_t>(count));
    std::fill(v.begin(), v.end(), 7u);
    v = ZeroVector<std::uint32_t>();
    v.resize(count);
    EXPECT_EQ(std::count(v.begin(), v.end(), 0u), static_cast<std::ptrdiff_t>(count));
  }
}

TEST(BaseZeroPages, TakeMemoryWhenTheyAreWritten) {
  if (!support::kMeasuresMemory) GTEST_SKIP();
  constexpr std::size_t kSize = std::size_t{1} << 28;
  const std::uint64_t before = support::resident_memory();
  ZeroVector<std::uint8_t> v(kSize);
  EXPECT_LT(support::resident_memory(), before + kSize / 2);
  std::fill(v.begin(), v.end(), std::uint8_t{1});
  EXPECT_GT(support::resident_memory(), before + kSize / 2);
}

}  // namespace
}  // namespace orrery::base
