// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "kernel/pixel_sum.h"
#include "render/pixel_noise.h"

namespace orrery::test {

/// Pixel statistics of two halves of `samples` samples each. A sample's value is `light(x, y, u)` in all three
/// channels, with a uniform random number u.
template <class Light>
render::PixelStatistics statistics_of(int width, int height, std::uint32_t samples, unsigned seed, Light light) {
  render::PixelStatistics s(width, height);
  std::mt19937 random(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      kernel::PixelSum halves[2];
      float largest = 0;
      for (kernel::PixelSum& half : halves) {
        half.weight = samples;
        for (std::uint32_t k = 0; k < samples; ++k) {
          const auto value = static_cast<double>(light(x, y, static_cast<double>(random()) * 0x1p-32));
          for (auto& channel : half.rgb) channel += kernel::to_fixed_point(value);
          largest = std::max(largest, static_cast<float>(3 * value));
        }
      }
      s.set(s.at(x, y), samples, halves[0], halves[1], largest);
    }
  }
  return s;
}

}  // namespace orrery::test
