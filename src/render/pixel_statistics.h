// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace orrery::render {

/// Coverage of a pixel by the small emitters within it; see find_small_emitters.
struct EmitterCoverage {
  float coverage = 0;  ///< fraction of the pixel
  float light = 0;     ///< radiance that they add to the pixel, mean of the three channels
};

/// Statistics of each pixel from its two independent halves of samples, in row-major order.
struct PixelStatistics {
  PixelStatistics(int width_px, int height_px)
      : width(width_px),
        height(height_px),
        samples(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)),
        light(samples.size()),
        variance(samples.size()) {}

  int width, height;                   ///< px
  std::vector<std::uint32_t> samples;  ///< samples in each half, above 0
  std::vector<float> light;            ///< mean over both halves and the three channels, at least 0
  std::vector<float> variance;         ///< variance of `light`, mean of the three channels
  /// 1: no path reached anything that could emit, so the pixel is black; empty: not known for any pixel.
  std::vector<std::uint8_t> known_black;
  std::vector<EmitterCoverage> small_emitters;  ///< empty: there are none

  bool is_known_black(std::size_t i) const { return !known_black.empty() && known_black[i] != 0; }
  bool has_small_emitters(std::size_t i) const { return !small_emitters.empty() && small_emitters[i].light > 0; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Samples per pixel in each half from which every error estimate counts as reliable.
inline constexpr std::uint32_t kSamplesForReliability = 512;

/// Number of interleaved pixel classes, (x mod 3, y mod 3). A pixel's 5 x 5 window has no other pixel of its class.
inline constexpr int kClasses = 9;
/// Value of `excluded_class` that excludes no class.
inline constexpr int kNoClass = -1;

inline int class_of(int x, int y) { return x % 3 + y % 3 * 3; }

}  // namespace orrery::render
