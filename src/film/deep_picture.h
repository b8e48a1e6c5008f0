// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::film {

/// What one sphere, or the background, gives to a pixel: light and coverage from `front` to `back`.
struct DeepSample {
  float front, back;  ///< distance along the view, scene units
  float rgb[3];       ///< premultiplied by alpha
  float alpha;        ///< of this sample alone: what stands behind it is seen through 1 - alpha
};

/// A picture whose pixels hold samples in depth, nearest first. Laid over each other they are the flat picture.
struct DeepPicture {
  int width = 0, height = 0;                    ///< px
  std::vector<std::vector<DeepSample>> pixels;  ///< rows from the top
};

}  // namespace orrery::film
