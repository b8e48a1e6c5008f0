// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// Pixels that an eye sees in a degree: a screen of 3840 pixels and 0.7 m across, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206433;

/// Calls work(i) for i = 0 .. count - 1, in any order and from any threads, and passes on what it throws.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t i)>& work)>;

/// How much a viewer who flips between two pictures notices at each pixel, 0..1.
///
/// Domain     codes 0..1 of an sRGB screen; views of the same size
/// Reference  andersson2020
Map flip(const ColorView& picture, const ColorView& reference, double pixels_per_degree = kPixelsPerDegree);

/// The same for scene-linear light: the most that is noticed at any exposure, from that which shows the brightest to
/// that which shows the darker half, through the tone curve of the paper.
///
/// `for_each` computes the exposures; by default one after the other
/// Domain     light in the primaries of Rec. 709; what is below 0 counts as 0
/// Reference  andersson2021
Map hdr_flip(const ColorView& picture, const ColorView& reference, double pixels_per_degree = kPixelsPerDegree,
             const ForEach& for_each = {});

}  // namespace orrery::metrics
