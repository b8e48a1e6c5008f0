// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kernel/pixel_sum.h"

namespace orrery::film {

/// Lower bound of the radiance in the denominator of relative errors: 1/64 of display white, which is encoded as about
/// 1/8. Errors are less visible below it.
inline constexpr double kDarkestLight = 1.0 / 64;

/// The squared relative error of a pixel's display value.
///
/// A display value is roughly the square root of radiance, so its relative error is half that of radiance. The three
/// channels are combined: the mean of their squared errors over the square of their mean radiance.
///
/// Domain     `squares` is the sum of the three channels' squared radiance errors, `light` the sum of their radiance
inline double display_error_squared(double squares, double light) noexcept {
  const double mean = light / 3 > kDarkestLight ? light / 3 : kDarkestLight;
  return squares / 3 / (4 * mean * mean);
}

/// Mean radiance of a pixel and its variance, estimated from two independent halves of its samples. Both values are
/// means over the three channels.
struct HalvesEstimate {
  double light = 0;
  double variance = 0;  ///< expected squared error of `light`; 0 if a half has no samples
  double color = 1;     ///< mean square of the channels over the square of their mean: 1 if grey, 3 if only one is lit
};

inline HalvesEstimate compare_halves(const kernel::PixelSum& a, const kernel::PixelSum& b) noexcept {
  HalvesEstimate out;
  if (a.weight <= 0 || b.weight <= 0) return out;
  double squares = 0;
  for (int c = 0; c < 3; ++c) {
    const double x = kernel::from_fixed_point(a.rgb[c]) / static_cast<double>(a.weight);
    const double y = kernel::from_fixed_point(b.rgb[c]) / static_cast<double>(b.weight);
    out.variance += (x - y) * (x - y) / 4 / 3;  // the mean's expected error is half the difference of the halves
    out.light += (x + y) / 2 / 3;
    squares += (x + y) * (x + y) / 4 / 3;
  }
  if (out.light > 0) out.color = std::min(squares / (out.light * out.light), 3.0);
  return out;
}

}  // namespace orrery::film
