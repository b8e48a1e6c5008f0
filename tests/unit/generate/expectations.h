// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>

namespace orrery::generate {

/// Tolerance of five standard deviations: with fixed seeds, a failure is not chance.
inline void expect_near_mean(double mean, double expected, double variance, double n, const char* what) {
  EXPECT_NEAR(mean, expected, 5 * std::sqrt(variance / n)) << what << " of " << n;
}

}  // namespace orrery::generate
