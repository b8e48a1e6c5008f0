// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// Family-wise error rate: the probability of any false positive among all tests of a comparison.
inline constexpr double kFamilyWiseError = 0.01;

/// Side of the square blocks whose means are tested; large enough for the block means to be nearly normal.
inline constexpr int kTestedSide = 16;  // px

/// Result of a z-test of whether two noisy images show the same scene, and the split of their difference into noise and
/// bias.
struct ZTest {
  int tests = 0;                  ///< number of blocks that have variance or differ, counted per channel
  int rejected = 0;               ///< number of tests with |z| above critical_z
  double largest_z = 0;           ///< z of the largest magnitude; positive if the image is brighter than the reference
  int channel = 0, x = 0, y = 0;  ///< channel of largest_z, and upper left corner of its block, px
  double critical_z = 0;          ///< two-sided critical value, Bonferroni-corrected to kFamilyWiseError
  double noise = 0;               ///< root mean square error explained by the variances
  double bias = 0;                ///< root mean square error not explained by them; 0 if they explain all
  double mean_bias = 0;           ///< mean of image - reference, relative to the mean of the reference
  double mean_bias_error = 0;     ///< standard error of mean_bias

  bool differ() const { return rejected > 0; }
};

/// z of a block without variance whose means differ: the difference cannot be noise.
inline constexpr double kCertainZ = 1e6;

/// Compares the means of blocks of kTestedSide px in each channel. A block without variance differs if all of its
/// pixels differ in the same direction by more than the precision of half, and it is not black.
///
/// Domain     views of the same size; variances are those of the pixel means; a reference without variance is exact
/// Result     empty if the image has no variance
std::optional<ZTest> z_test(const ColorView& picture, const ColorView& variance, const ColorView& reference,
                            const ColorView& reference_variance);

/// Returns the z such that |Z| > z with probability `chance` for a standard normal variable Z.
double two_sided_quantile(double chance);

}  // namespace orrery::metrics
