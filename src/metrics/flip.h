// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metrics/color_view.h"

namespace orrery::metrics {

/// Pixels that an eye sees in a degree: a screen of 3840 pixels and 0.7 m across, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206433;

/// How much a viewer who flips between two pictures notices at each pixel, 0..1.
///
/// Domain     codes 0..1 of an sRGB screen; views of the same size
/// Reference  andersson2020
Map flip(const ColorView& picture, const ColorView& reference, double pixels_per_degree = kPixelsPerDegree);

/// The same for scene-linear light: the most that is noticed at any exposure, from that which shows the brightest to
/// that which shows the darker half, through the tone curve of the paper.
///
/// Domain     light in the primaries of Rec. 709; what is below 0 counts as 0
/// Reference  andersson2021
Map hdr_flip(const ColorView& picture, const ColorView& reference, double pixels_per_degree = kPixelsPerDegree);

}  // namespace orrery::metrics
