// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

/// A pixel filter, importance sampled: it displaces a path's start within and around the pixel, so all weights are 1 or
/// -1 and pixels stay independent.
///
/// A filter with negative lobes gives the weight -1 to a fixed fraction of the samples, evenly spaced in sample number,
/// and draws these samples from its negative part. The sum of the weights is then not random, and flat areas stay flat.
struct PixelFilter {
  static constexpr int kSteps = 1024;

  /// The filter is separable and symmetric. Inverse distribution functions of its positive and its negative part along
  /// one axis: distances from the pixel's centre, px, at kSteps + 1 evenly spaced probabilities. Null: a box of one
  /// pixel.
  const double* above = nullptr;
  const double* below = nullptr;
  std::uint32_t negative_share = 0;  ///< fraction of all samples with the weight -1, in units of 2^-32
  double below_twice = 0;            ///< fraction of the others that are negative along both axes

  std::int64_t negatives_before(std::uint64_t sample) const noexcept {
    return static_cast<std::int64_t>(sample * negative_share >> 32);
  }
  /// The sum of the weights of samples begin .. end of a pixel.
  std::int64_t weight(std::uint64_t begin, std::uint64_t end) const noexcept {
    return static_cast<std::int64_t>(end - begin) - 2 * (negatives_before(end) - negatives_before(begin));
  }
};

}  // namespace orrery::kernel
