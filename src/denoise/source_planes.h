// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "denoise/outliers.h"
#include "denoise/planes.h"
#include "denoise/tile_filter.h"
#include "film/picture.h"

namespace orrery::denoise {

/// The planes of an image that guide its filter.
struct SourcePlanes {
  std::array<PaddedPlane, 3> a, b;  ///< the beauty of two halves of the samples
  Outliers outliers;                ///< already reduced in `a` and `b`
  PaddedPlane variance;             ///< variance of the beauty, summed over the channels
  std::vector<PaddedPlane> guides;  ///< kGuides
  PaddedPlane guide_variance;       ///< sum over the guides
  PaddedPlane valid;                ///< 1; 0 outside the image and where the beauty is not finite
};

/// Prepares the planes of an image with a beauty R, G, B and the layer `halves`. Values that are not finite are
/// replaced by 0.
///
/// `keeps_halves`  false: the layer `halves` is removed, each plane as soon as it is not needed
/// Result     empty if more than a sixteenth of the pixels have samples in one half only: the noise cannot be measured
/// Errors     base::Error: kBadData if the image lacks the layer `halves`; kStopped in a base::StopScope
std::optional<SourcePlanes> source_planes(film::Picture& picture, bool keeps_halves);

}  // namespace orrery::denoise
