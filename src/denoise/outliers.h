// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "denoise/plane_values.h"

namespace orrery::denoise {

/// A pixel that one half of the samples alone shows far brighter than its surroundings.
struct Outlier {
  std::size_t pixel;  ///< index
  bool is_in_a;       ///< the first half is the bright one
  /// Its light is spread over the image. Otherwise there is too much of it, and the pixel gets it back.
  bool is_spread;
  float kept;  ///< fraction of the difference of the halves that is kept
  /// Factors of R, G and B by which its light becomes about that of the other half; at most 1, not 0.
  std::array<float, 3> factors;
};

/// The outliers of an image, and how much noise of a pixel counts for others.
struct Outliers {
  std::vector<Outlier> pixels;  ///< in rows from the top
  Values limits;                ///< largest standard deviation of each pixel that its neighbours' variance includes

  /// The first outlier from a pixel on.
  std::vector<Outlier>::const_iterator lower_bound(std::size_t pixel) const {
    return std::lower_bound(pixels.begin(), pixels.end(), pixel,
                            [](const Outlier& outlier, std::size_t at) { return outlier.pixel < at; });
  }
};

/// Finds the outliers of an image: pixels whose halves differ so much more than those of the pixels around them that
/// their light, averaged over the filter's window, would show as a square. Light that both halves saw, such as a small
/// highlight, is no outlier, nor are bright pixels of which there are many.
///
/// `halves`   R, G, B
Outliers find_outliers(const std::vector<HalfPair>& halves, Frame frame);

}  // namespace orrery::denoise
