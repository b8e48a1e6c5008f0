// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "metrics/color_view.h"

namespace orrery::metrics {

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

}  // namespace orrery::metrics
