// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "compare/color_view.h"

namespace orrery::compare {

/// The channels of an image.
using Maps = std::array<Map, 3>;

/// The values of a view, changed by `change`. Those that are not finite become 0, since filters would spread them.
template <class Change>
Maps maps_of(const ColorView& view, Change change) {
  Maps out;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = {view.width, view.height, std::vector<float>(view.pixels())};
    std::transform(view.channel[c], view.channel[c] + view.pixels(), out[c].values.begin(),
                   [&](float v) { return std::isfinite(v) ? change(v) : 0.0f; });
  }
  return out;
}

/// A one-dimensional kernel of 2 * radius + 1 taps.
using Taps = std::vector<float>;

/// Convolves a map with a separable kernel. The edge pixels are extended beyond the border.
Map convolved(const Map& map, const Taps& along_x, const Taps& along_y);

/// The mean structural similarity (SSIM) of the luma of two display-encoded images.
///
/// Domain     values 0..1; images of the same size
/// Result     1 for identical images
/// Reference  wang2004: 11 x 11 Gaussian window, sigma 1.5, K1 = 0.01, K2 = 0.03; edge pixels extended past the border
double ssim(const Maps& picture, const Maps& reference);

/// Pixels per degree of visual angle for a display 3840 pixels and 0.7 m wide, viewed from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206433;

/// The FLIP error map: the difference per pixel that a viewer perceives when alternating between two images.
///
/// Domain     sRGB-encoded values 0..1; images of the same size
/// Result     0..1
/// Reference  andersson2020
Map flip(const Maps& picture, const Maps& reference);

/// The HDR-FLIP error map of scene-linear images: the maximum of flip() over a range of exposures, tone-mapped with the
/// curve of the paper. The range extends from the exposure for the brightest pixel to that for the median.
///
/// `threads`  on which the exposures run
/// Domain     linear Rec. 709; negative values count as 0
/// Reference  andersson2021
Map hdr_flip(const Maps& picture, const Maps& reference, int threads = 1);

}  // namespace orrery::compare
