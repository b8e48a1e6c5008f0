// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compare/color_view.h"

namespace orrery::compare {

/// Term in the denominator of the relative error that keeps it finite for black: the square of a tenth of white.
inline constexpr double kRelativeFloor = 0.01;

/// Error metrics of an image a against a reference b.
struct PixelErrors {
  double rmse = 0;          ///< root mean squared error
  double mae = 0;           ///< mean absolute error
  double relative_mse = 0;  ///< mean of (a - b)^2 / (b^2 + kRelativeFloor)
  double display = 0;       ///< error that `--noise` limits: root mean of film::display_error_squared over pixels
  double bias = 0;          ///< mean of a - b, relative to the mean of b; positive if a is too bright
  double max = 0;           ///< maximum absolute difference
  int max_channel = -1, max_x = 0, max_y = 0;  ///< channel and pixel of `max`; channel -1 if the images are equal
  std::uint64_t values = 0;                    ///< number of values compared
  std::uint64_t not_finite = 0;                ///< number of values skipped because a or b is NaN or infinite

  /// Peak signal-to-noise ratio in decibels for a peak of 1; infinite if the images are equal.
  double psnr_db() const;
};

/// Computes the error metrics of an image.
///
/// Domain     views of the same size, with channels; `excluded` flags the pixels to skip, empty for none
PixelErrors pixel_errors(const ColorView& picture, const ColorView& reference, const std::vector<bool>& excluded = {});

/// The display error of every pixel; 0 if the pixel is skipped or a value is not finite. PixelErrors::display is its
/// root mean square over the pixels that are not skipped.
Map display_error_map(const ColorView& picture, const ColorView& reference, const std::vector<bool>& excluded = {});

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

}  // namespace orrery::compare
