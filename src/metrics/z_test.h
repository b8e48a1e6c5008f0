// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// The chance of a false alarm in a whole comparison, whatever the number of its tests.
inline constexpr double kFamilyWiseError = 0.01;

/// Sides of the squares whose means are tested: large enough for means of samples to be nearly normal.
inline constexpr int kTestedSide = 16;  // px

/// Whether two noisy pictures can be of the same scene, and how much of their difference is noise.
struct ZTest {
  int tests = 0;                  ///< squares of kTestedSide, each channel apart, that have any variance
  int rejected = 0;               ///< those beyond the critical value
  double largest_z = 0;           ///< with its sign: picture less reference
  int channel = 0, x = 0, y = 0;  ///< where that is, px, upper left corner of the square
  double critical_z = 0;          ///< Bonferroni's, for kFamilyWiseError over all tests, two-sided
  double noise = 0;               ///< root mean square error that the variances explain
  double bias = 0;                ///< root mean square of what they don't; 0 where they explain all
  double mean_bias = 0;           ///< relative: mean of a - b by mean of b
  double mean_bias_error = 0;     ///< its standard error

  bool differ() const { return rejected > 0; }
};

/// Variances are those of the means of pixels; a reference that has none counts as exact.
///
/// Domain     views of the same size
/// Result     nothing where the picture has no variance
std::optional<ZTest> z_test(const ColorView& picture, const ColorView& variance, const ColorView& reference,
                            const ColorView& reference_variance);

/// The z that a normal variable exceeds in absolute value with this chance.
double two_sided_quantile(double chance);

}  // namespace orrery::metrics
