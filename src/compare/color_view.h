// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "film/picture.h"
#include "math/pixels.h"

namespace orrery::compare {

/// A view of three planes of an image as a colour, row by row from the top.
struct ColorView {
  int width = 0, height = 0;  ///< px
  const float* channel[3] = {nullptr, nullptr, nullptr};

  std::size_t pixels() const { return math::pixel_count(width, height); }
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

/// Maps the values 0 .. `full` to the colour map magma, from black through violet and orange to pale yellow.
///
/// Result     sRGB-encoded values 0..1
/// Reference  matplotlib's "magma", sampled at every sixteenth entry
film::Picture false_color(const Map& map, double full);

/// Quantizes an sRGB-encoded image to 8 bits.
///
/// Domain     planes R, G, B; values are clamped to 0..1
film::EncodedPicture encoded(const film::Picture& codes);

/// A map as a grey image with the same values in R, G and B.
film::Picture grey(const Map& map);

/// Display error at the upper end of a heat map's scale.
inline constexpr double kFalseColorMax = 0.1;

}  // namespace orrery::compare
