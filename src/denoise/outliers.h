// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "denoise/planes.h"

namespace orrery::denoise {

/// A pixel that is far brighter than its surroundings in only one half of the samples.
struct Outlier {
  std::size_t pixel;  ///< index
  bool is_in_a;       ///< the first half is the bright one
  /// True if its light is spread over the image. Otherwise there is too much of it, and it is returned to the pixel.
  bool is_spread;
  float kept;  ///< fraction of the difference of the halves that is kept
  /// Factors of R, G and B by which its light becomes about that of the other half; at most 1, not 0.
  std::array<float, 3> factors;
};

/// The outliers of an image, and the limits of noise that a pixel passes to its neighbours.
struct Outliers {
  std::vector<Outlier> pixels;  ///< in rows from the top
  Values limits;  ///< per pixel, the maximum standard deviation that contributes to its neighbours' variance

  /// The first outlier from a pixel on.
  std::vector<Outlier>::const_iterator lower_bound(std::size_t pixel) const {
    return std::lower_bound(pixels.begin(), pixels.end(), pixel,
                            [](const Outlier& outlier, std::size_t at) { return outlier.pixel < at; });
  }
};

/// Finds the outliers of an image: pixels whose halves differ so much more than those of the pixels around them that
/// their light, averaged over the filter's window, would show as a square. Light that both halves contain, such as a
/// small highlight, is not an outlier; nor are bright pixels if there are many.
///
/// `halves`   R, G, B
Outliers find_outliers(const std::vector<HalfPair>& halves, Frame frame);

}  // namespace orrery::denoise
