// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "film/picture.h"
#include "kernel/forward.h"

namespace orrery::film {

struct LayerRequest;
struct Sums;

/// Planes whose values are computed together.
struct LayerPlanes {
  std::vector<Plane> planes;  ///< in file order, without values
  /// Computes the value of a pixel in each plane. Threads may call it concurrently.
  std::function<void(std::size_t pixel, float* values)> values_of;
};

/// R, G, B, A, and the requested layers in file order, from the sums of a render.
///
/// Domain     the arguments outlive the result; `sums` has the arrays of the request
std::vector<LayerPlanes> image_planes(const LayerRequest& request, const kernel::SceneView& view, const Sums& sums);

/// The planes of the requested layers in file order, without values.
std::vector<Plane> planes_of(const LayerRequest& request);

/// The deep samples of a pixel, nearest first, with alphas that composite to each sphere's coverage.
///
/// Domain     LayerRequest::deep
std::vector<DeepSample> deep_samples(const Sums& sums, std::size_t pixel, bool background_visible);

}  // namespace orrery::film
