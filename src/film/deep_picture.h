// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::film {

/// Radiance and coverage of one sphere, or of the background, in a pixel.
struct DeepSample {
  float front, back;  ///< range along the view axis, scene units
  float rgb[3];       ///< premultiplied by alpha
  float alpha;        ///< opacity of this sample alone
};

/// A deep image: each pixel holds its samples, nearest first. Compositing them gives the flat image.
struct DeepPicture {
  int width = 0, height = 0;                    ///< px
  std::vector<std::vector<DeepSample>> pixels;  ///< rows from the top
};

}  // namespace orrery::film
