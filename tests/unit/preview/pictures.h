// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "film/sums.h"
#include "kernel/pixel_sum.h"
#include "math/pixels.h"
#include "preview/canvas.h"

namespace orrery::preview {

/// A film in which every pixel has one sample of its own value.
inline film::Sums sums(int width, int height, double offset = 0) {
  film::Sums state(width, height);
  for (std::size_t i = 0; i < state.pixel_count(); ++i) {
    kernel::PixelSum& sum = state.light[0][i];
    for (int c = 0; c < 3; ++c) sum.rgb[c] = kernel::to_fixed_point(offset + 0.001 * static_cast<double>(3 * i) + c);
    sum.weight = 1;
  }
  return state;
}

/// All pixels of a rectangle.
inline std::vector<kernel::PixelPlace> all_pixels(int width, int height) {
  std::vector<kernel::PixelPlace> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out.push_back({x, y});
  return out;
}

template <class To>
void write_all(const film::Sums& state, To& to) {
  const std::vector<kernel::PixelPlace> pixels = all_pixels(state.width, state.height);
  to.write(state, {0, 0, state.width, state.height, pixels});
}

/// The means of a sums, R, G, B of all pixels.
inline std::vector<float> means(const film::Sums& state) {
  std::vector<float> out;
  for (int y = 0; y < state.height; ++y)
    for (int x = 0; x < state.width; ++x) {
      float rgb[3];
      state.mean(math::pixel_index(x, y, state.width), rgb);
      out.insert(out.end(), rgb, rgb + 3);
    }
  return out;
}

}  // namespace orrery::preview
