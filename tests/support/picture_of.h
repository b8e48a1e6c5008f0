// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "film/layer_planes.h"
#include "film/picture.h"
#include "film/sums.h"
#include "kernel/scene_view.h"

namespace orrery::test {

/// The image of the sums so far, with the layers of a request.
inline film::Picture picture_of(const film::Sums& sums, const film::LayerRequest& request = {},
                                const kernel::SceneView& view = {}) {
  film::Picture out{sums.width, sums.height, {}};
  for (film::LayerPlanes& layer : film::image_planes(request, view, sums)) {
    std::vector<float> values(layer.planes.size());
    for (std::size_t i = 0; i < sums.pixel_count(); ++i) {
      layer.values_of(i, values.data());
      for (std::size_t k = 0; k < values.size(); ++k) layer.planes[k].values.push_back(values[k]);
    }
    out.planes.insert(out.planes.end(), layer.planes.begin(), layer.planes.end());
  }
  return out;
}

}  // namespace orrery::test
