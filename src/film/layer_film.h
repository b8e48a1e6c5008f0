// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "film/layer_pixel.h"
#include "film/picture.h"

namespace orrery::film {

struct LayerRequest;

/// The planes of the requested layers in file order, without values.
std::vector<Plane> planes_of(const LayerRequest& request);

/// The layer planes of an image, filled pixel by pixel.
class LayerFilm {
 public:
  /// Allocates the planes of the requested layers for an image of this size.
  ///
  /// Domain     request and view outlive this
  LayerFilm(const LayerRequest& request, const kernel::SceneView& view, int width_px, int height_px);
  LayerFilm(const LayerRequest&, const kernel::SceneView&&, int, int) = delete;  // a temporary would not outlive this

  /// Sets all layers of a pixel from its sums. Threads may set different pixels concurrently.
  ///
  /// Domain     `pixel` is an index into the rows from the top left; `halves` and `beauty` are sums over the same paths
  void set(std::size_t pixel, const LayerPixel& sums, const Halves& halves, const kernel::PixelSum& beauty);

  /// Appends the layers to an image of R, G, B, A, and replaces A by the coverage if that was requested.
  void move_to(Picture& picture);

  /// Moves the deep image out; empty unless it was requested.
  DeepPicture take_deep();

 private:
  const LayerRequest& request_;
  const kernel::SceneView& view_;
  std::vector<Plane> planes_;
  std::vector<float> coverage_;
  DeepPicture deep_;
};

}  // namespace orrery::film
