// SPDX-License-Identifier: Apache-2.0
#include "base/duplicates.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <utility>

namespace orrery::base {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs repeated(const std::vector<std::array<double, 2>>& keys) {
  Pairs out;
  for (const Duplicate& r : find_duplicates<2>(keys.size(), [&](std::size_t i) { return keys[i]; }))
    out.emplace_back(r.index, r.first);
  return out;
}

TEST(BaseDuplicates, ReportsTheFirstItemWithTheSameKey) {
  EXPECT_EQ(repeated({}), Pairs());
  EXPECT_EQ(repeated({{1, 2}, {2, 1}, {1, 2}, {3, 3}, {2, 1}, {1, 2}}), (Pairs{{2, 0}, {4, 1}, {5, 0}}));
}

TEST(BaseDuplicates, IgnoresTheSignOfZeroAndNaNEqualsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(repeated({{0, 1}, {-0.0, 1}, {nan, 1}, {nan, 1}}), (Pairs{{1, 0}}));
}

/// Enough keys for false positives in the filters, and for several threads.
TEST(BaseDuplicates, FindsExactlyTheRepeatedItemsAmongMany) {
  std::mt19937_64 engine{5};
  std::vector<std::array<double, 2>> keys;
  for (int i = 0; i < 600'000; ++i) keys.push_back({static_cast<double>(engine() >> 11), 0});
  Pairs expected;
  for (std::size_t i = 300'000; i < keys.size(); i += 1000) {
    keys[i] = keys[i / 3];
    expected.emplace_back(i, i / 3);
  }
  EXPECT_EQ(repeated(keys), expected);
}

}  // namespace
}  // namespace orrery::base
