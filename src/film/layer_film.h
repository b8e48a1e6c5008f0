// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "film/deep_picture.h"
#include "film/layer_pixel.h"
#include "film/layers.h"
#include "film/picture.h"
#include "kernel/scene_view.h"

namespace orrery::film {

/// The planes that a request comes to, in their order, without values.
std::vector<Plane> planes_of(const LayerRequest& request);

/// The layers of a picture, pixel by pixel, as they become known.
class LayerFilm {
 public:
  /// Domain     request and view outlive this
  LayerFilm(const LayerRequest& request, const kernel::SceneView& view, int width_px, int height_px);

  /// Writes down what the paths of a pixel came to. Different pixels may be set at the same time.
  ///
  /// `pixel` counts from the upper left one, row by row.
  void set(std::size_t pixel, const LayerPixel& sums);

  /// Appends the layers to a picture of R, G, B, A; A becomes the coverage where that was asked for.
  void move_to(Picture& picture);

  /// The deep picture, where that was asked for.
  DeepPicture take_deep();

 private:
  const LayerRequest& request_;
  kernel::SceneView view_;
  std::vector<Plane> planes_;
  std::vector<float> coverage_;
  DeepPicture deep_;
};

}  // namespace orrery::film
