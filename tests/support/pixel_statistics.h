// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "render/light_guide.h"

namespace orrery::test {

/// Pixel statistics of two halves of `samples` samples each. A sample's value is `light(x, y, u)` in all three
/// channels, with a uniform random number u.
template <class Light>
render::PixelStatistics statistics_of(int width, int height, std::uint32_t samples, unsigned seed, Light light) {
  render::PixelStatistics s(width, height);
  std::mt19937 random(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double halves[2] = {0, 0};
      for (double& half : halves)
        for (std::uint32_t k = 0; k < samples; ++k)
          half += static_cast<double>(light(x, y, static_cast<double>(random()) * 0x1p-32)) / samples;
      const std::size_t i = s.at(x, y);
      s.samples[i] = samples;
      s.light[i] = static_cast<float>((halves[0] + halves[1]) / 2);
      s.variance[i] = static_cast<float>((halves[0] - halves[1]) * (halves[0] - halves[1]) / 4);
    }
  }
  return s;
}

}  // namespace orrery::test
