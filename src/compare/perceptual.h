// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "compare/color_view.h"

namespace orrery::compare {

/// A one-dimensional kernel of 2 * radius + 1 taps.
using Taps = std::vector<float>;

/// Convolves a map with a separable kernel. The edge pixels are extended beyond the border.
Map convolved(const Map& map, const Taps& along_x, const Taps& along_y);

/// The mean structural similarity (SSIM) of the luma of two display-encoded images.
///
/// Domain     values 0..1; views of the same size, with channels
/// Result     1 for identical images
/// Reference  wang2004: 11 x 11 Gaussian window, sigma 1.5, K1 = 0.01, K2 = 0.03; edge pixels extended past the border
double ssim(const ColorView& picture, const ColorView& reference);

/// Pixels per degree of visual angle for a display 3840 pixels and 0.7 m wide, viewed from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206433;

/// The FLIP error map: the difference per pixel that a viewer perceives when alternating between two images.
///
/// Domain     sRGB-encoded values 0..1; views of the same size
/// Result     0..1
/// Reference  andersson2020
Map flip(const ColorView& picture, const ColorView& reference);

/// The HDR-FLIP error map of scene-linear images: the maximum of flip() over a range of exposures, tone-mapped with the
/// curve of the paper. The range extends from the exposure for the brightest pixel to that for the median.
///
/// `threads`  on which the exposures run
/// Domain     linear Rec. 709; negative values count as 0
/// Reference  andersson2021
Map hdr_flip(const ColorView& picture, const ColorView& reference, int threads = 1);

}  // namespace orrery::compare
