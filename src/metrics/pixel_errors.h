// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// Keeps black from making the relative error infinite: a tenth of white, squared.
inline constexpr double kRelativeFloor = 0.01;

/// How far a picture is from a reference, value by value.
struct PixelErrors {
  double rmse = 0;          ///< root of the mean squared difference
  double mae = 0;           ///< mean of the absolute difference
  double relative_mse = 0;  ///< mean of (a - b)^2 / (b^2 + kRelativeFloor)
  double display = 0;       ///< what `--noise` promises: root of the mean of film::display_error_squared over pixels
  double bias = 0;          ///< mean of a - b, by the mean of b: energy that is too much
  double max = 0;           ///< largest absolute difference
  int max_channel = -1, max_x = 0, max_y = 0;  ///< where it is; -1 where nothing differs
  std::uint64_t values = 0;                    ///< that were compared
  std::uint64_t not_finite = 0;                ///< values left out, since a or b is NaN or infinite

  /// Peak signal to noise, decibels, for a peak of 1; infinite where nothing differs.
  double psnr_db() const;
};

/// `left_out` pixels that do not count; empty: all count
/// Domain     views of the same size, with channels
PixelErrors pixel_errors(const ColorView& picture, const ColorView& reference, const std::vector<bool>& left_out = {});

/// The display error of every pixel, 0 if it is left out or a value is not finite. The mean of its squares over the
/// pixels that are not left out is the square of PixelErrors::display.
Map display_error_map(const ColorView& picture, const ColorView& reference, const std::vector<bool>& left_out = {});

}  // namespace orrery::metrics
