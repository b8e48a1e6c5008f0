// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "render/pixel_shard.h"

namespace orrery::render {

/// Which samples are rendered, and when adaptive sampling stops.
struct SamplingLimits {
  /// Target noise, as film/display_error.h measures it: samples go where they reduce the image's error most, until it
  /// is this low. 0: every pixel gets the scene's samples.
  double noise = 0;
  double seconds = 0;      ///< time budget for adaptive sampling; 0: none
  bool unlimited = false;  ///< with noise or seconds: more samples per pixel than the scene's are allowed
  /// Range of each pixel's samples. The sums of disjoint ranges add up to those of one render. end 0: all samples.
  std::uint32_t sample_begin = 0, sample_end = 0;
  PixelShard shard;  ///< only these pixels

  /// True if the pixels are sampled adaptively.
  bool is_adaptive() const { return noise > 0 || seconds > 0; }
  /// Takes time that has passed from the time budget, if there is one.
  void spend(double used_s) {
    constexpr double kShortest = 1e-3;  // 0 would be no limit
    if (seconds > 0) seconds = std::max(seconds - used_s, kShortest);
  }
  /// True if these are not all samples of all pixels.
  bool is_partial() const { return sample_end > 0 || shard.count > 1; }
};

}  // namespace orrery::render
