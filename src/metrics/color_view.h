// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "film/picture.h"

namespace orrery::metrics {

/// Three planes of a picture that are a colour, rows from the top.
struct ColorView {
  int width = 0, height = 0;  ///< px
  const float* channel[3] = {nullptr, nullptr, nullptr};

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// A map of one number for each pixel.
struct Map {
  int width = 0, height = 0;  ///< px
  std::vector<float> values;

  double mean() const;
};

/// The planes PREFIX.R, .G, .B of a picture, or R, G, B for an empty prefix.
///
/// Result     channels are null where the picture has none
ColorView color_of(const film::Picture& picture, const std::string& prefix = "");

}  // namespace orrery::metrics
