// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "denoise/plane_values.h"

namespace orrery::denoise {

class Tiles;
struct SourcePlanes;

/// Filters the guides with weights from their own similarity. Guides are noisy under defocus and motion blur, and
/// behind glass.
///
/// Result     kGuides planes
std::vector<PaddedPlane> filtered_guides(const SourcePlanes& planes, Frame frame, Tiles& tiles);

/// The prefiltered halves of the beauty, which determine the final weights.
struct FilteredHalves {
  std::array<PaddedPlane, 3> a, b;
  PaddedPlane variance;  ///< variance of their mean, summed over the channels
};

/// Filters both halves of the beauty with the same weights, over a small window.
///
/// `guides`   filtered
/// Reference  rousselle2012
FilteredHalves filtered_halves(const SourcePlanes& planes, const std::vector<PaddedPlane>& guides, Frame frame,
                               Tiles& tiles);

}  // namespace orrery::denoise
