// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::metrics {

/// A view of three planes of an image as a colour, row by row from the top.
struct ColorView {
  int width = 0, height = 0;  ///< px
  const float* channel[3] = {nullptr, nullptr, nullptr};

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// One value per pixel, row by row from the top.
struct Map {
  int width = 0, height = 0;  ///< px
  std::vector<float> values;

  double mean() const;
};

/// The planes PREFIX.R, PREFIX.G and PREFIX.B of an image, or R, G, B for an empty prefix.
///
/// Domain     the image outlives the view
/// Result     null channels if any of the planes is missing
ColorView color_of(const film::Picture& picture, const std::string& prefix = "");

/// The sRGB transfer function, IEC 61966-2-1, from linear 0..1 to encoded 0..1, and its inverse.
float srgb_encoded(float light);
float srgb_decoded(float code);

}  // namespace orrery::metrics
