// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernel/pixel_sum.h"

namespace orrery::film {

/// Light below this, a sixty-fourth of display white, counts as this much where errors are relative: an eighth of white
/// on a display, below which eyes forgive more.
inline constexpr double kDarkestLight = 1.0 / 64;

/// The squared error of a pixel as a display shows it, relative to its own brightness there.
///
/// A display value goes about as the square root of light, so its relative error is half of that of light. Colours are
/// taken together: the mean square of the three channels' errors, by the square of the mean of their light.
///
/// Domain     `squares` is the sum of the three channels' squared errors of light, `light` the sum of their light
inline double display_error_squared(double squares, double light) noexcept {
  const double mean = light / 3 > kDarkestLight ? light / 3 : kDarkestLight;
  return squares / 3 / (4 * mean * mean);
}

/// What two independent halves of a pixel's samples tell of their mean; means of the three channels.
struct HalvesEstimate {
  double light = 0;
  double variance = 0;  ///< its expected squared error; 0 where a half has no samples
};

HalvesEstimate compare_halves(const kernel::PixelSum& a, const kernel::PixelSum& b) noexcept;

}  // namespace orrery::film
