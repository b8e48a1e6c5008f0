// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// Pixels per degree of visual angle for a display 3840 pixels and 0.7 m wide, viewed from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206433;

/// Calls work(i) for i = 0 .. count - 1 in any order, on any thread, and rethrows its exceptions.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t i)>& work)>;

/// The FLIP error map: the difference per pixel that a viewer perceives when alternating between two images.
///
/// Domain     sRGB-encoded values 0..1; views of the same size
/// Result     0..1
/// Reference  andersson2020
Map flip(const ColorView& picture, const ColorView& reference, double pixels_per_degree = kPixelsPerDegree);

/// The HDR-FLIP error map of scene-linear images: the maximum of flip() over a range of exposures, tone-mapped with the
/// curve of the paper. The range extends from the exposure for the brightest pixel to that for the median.
///
/// Domain     linear Rec. 709; negative values count as 0. `for_each` runs the exposures; default: one after another
/// Reference  andersson2021
Map hdr_flip(const ColorView& picture, const ColorView& reference, double pixels_per_degree = kPixelsPerDegree,
             const ForEach& for_each = {});

}  // namespace orrery::metrics
