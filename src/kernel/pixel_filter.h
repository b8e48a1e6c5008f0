// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

/// How far from a pixel's middle its paths start, so that every path has the same weight but for its sign: the filter
/// is sampled by importance, and pixels stay independent.
///
/// A filter with negative lobes gives the weight -1 to a fixed share of the samples, evenly spread over their numbers,
/// and draws those from its negative part. So flat areas stay flat: what weights add up to does not depend on chance.
struct PixelFilter {
  static constexpr int kSteps = 1024;

  /// The filter is the product of one along x and one along y, and symmetric. Distances from the middle in pixels at
  /// kSteps + 1 even steps of the probability, for the part above zero and for that below. Null: the pixel's own
  /// square.
  const double* above = nullptr;
  const double* below = nullptr;
  std::uint32_t negative_share = 0;  ///< of all samples, those with the weight -1, in units of 2^-32
  double below_twice = 0;            ///< of the others, those that are below zero along both axes

  std::int64_t negatives_before(std::uint64_t sample) const noexcept {
    return static_cast<std::int64_t>(sample * negative_share >> 32);
  }
  /// What samples begin .. end of a pixel weigh together.
  std::int64_t weight(std::uint64_t begin, std::uint64_t end) const noexcept {
    return static_cast<std::int64_t>(end - begin) - 2 * (negatives_before(end) - negatives_before(begin));
  }
};

}  // namespace orrery::kernel
