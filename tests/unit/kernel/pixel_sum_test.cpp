// SPDX-License-Identifier: Apache-2.0
#include "kernel/pixel_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace orrery::kernel {
namespace {

TEST(KernelPixelSum, RoundTripsValuesToOneUnit) {
  for (const double x : {0.0, 1.0, 0.5, 3.999, 4.0, 4.25, 1e6, 0x1p35, 1.0 / 3, -0.75, -17.25})
    EXPECT_NEAR(from_fixed_point(to_fixed_point(x)), x, 0x1p-60) << x;
}

TEST(KernelPixelSum, IsIndependentOfOrder) {
  std::mt19937_64 random(1);
  std::vector<double> samples(10000);
  for (double& s : samples) s = std::uniform_real_distribution<double>(0, 8)(random);
  const auto sum = [&] {
    Int128 total = 0;
    for (const double s : samples) total += to_fixed_point(s);
    return total;
  };
  const Int128 once = sum();
  std::shuffle(samples.begin(), samples.end(), random);
  EXPECT_TRUE(sum() == once);
}

TEST(KernelPixelSum, HoldsTheMaximumCountOfMaximumSamples) {
  const Int128 sum = to_fixed_point(kLargestSample) * (std::int64_t{1} << 31);
  EXPECT_EQ(from_fixed_point(sum), 0x1p66);
}

}  // namespace
}  // namespace orrery::kernel
