// SPDX-License-Identifier: Apache-2.0
#include "math/single.h"

#include <gtest/gtest.h>

#include <vector>

namespace orrery::math {
namespace {

struct Numbers {
  double x, y, z, w;
};

TEST(MathSingle, RoundsAllNumbersOfALoop) {
  for (int count = 1; count < 20; ++count) {
    std::vector<Numbers> numbers;
    for (int i = 0; i < count; ++i) numbers.push_back({i + 0.1, i + 0.2, i + 0.3, i + 0.4});
    for (Numbers& n : numbers) n = {in_single_precision(n.x), in_single_precision(n.y), in_single_precision(n.z), n.w};
    for (int i = 0; i < count; ++i) {
      const Numbers& n = numbers[static_cast<std::size_t>(i)];
      volatile float x = static_cast<float>(i + 0.1), y = static_cast<float>(i + 0.2), z = static_cast<float>(i + 0.3);
      EXPECT_EQ(n.x, static_cast<double>(x));
      EXPECT_EQ(n.y, static_cast<double>(y));
      EXPECT_EQ(n.z, static_cast<double>(z));
      EXPECT_EQ(n.w, i + 0.4);
    }
  }
}

}  // namespace
}  // namespace orrery::math
