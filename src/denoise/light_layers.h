// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::denoise {

/// The planes of one colour channel: how its light is divided into layers. Members are indices of planes.
struct LightChannel {
  std::size_t beauty = 0;
  std::vector<std::size_t> cells;  ///< layers that are not sums of others, in the order of their rounding
  /// Layers that are sums of cells: the lobes of light groups, and the groups.
  struct Sum {
    std::size_t plane;
    std::vector<std::size_t> cells;  ///< indices into `cells`
  };
  std::vector<Sum> sums;
};

/// The light layers of an image, identified by name: lobe AOVs, light groups and the lobes of the groups.
struct LightLayers {
  std::vector<LightChannel> channels;  ///< R, G, B
  std::vector<std::string> names;      ///< names of the layers
};

/// Finds the light layers of an image that has R, G and B.
LightLayers find_light_layers(const film::Picture& picture);

/// Returns whether the cells add up to the beauty in all pixels with finite values, within half precision.
bool are_complete(const film::Picture& picture, const LightLayers& layers);

/// Rounds the filtered cells of a pixel so that they add up bit for bit (film::ExactParts). None is negative unless the
/// beauty is.
///
/// `cells`        in: filtered values. out: rounded
/// `beauty`       filtered
/// `is_complete`  the cells add up to the beauty; else the beauty has more light
void round_to_sum(std::vector<double>& cells, float beauty, bool is_complete);

}  // namespace orrery::denoise
