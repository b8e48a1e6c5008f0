// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace orrery::generate {

/// Tolerance of five standard deviations: with fixed seeds, a failure is not chance.
inline void expect_near_mean(double mean, double expected, double variance, double n, const char* what) {
  EXPECT_NEAR(mean, expected, 5 * std::sqrt(variance / n)) << what << " of " << n;
}

/// The kind of the error that an action throws; kInternal if it throws none.
inline base::ErrorKind kind_of_error(const auto& action) {
  try {
    action();
  } catch (const base::Error& error) {
    return error.kind();
  }
  return base::ErrorKind::kInternal;
}

}  // namespace orrery::generate
