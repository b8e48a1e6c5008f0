// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/zero_pages.h"
#include "kernel/forward.h"
#include "kernel/pixel_sum.h"
#include "kernel/sphere.h"

namespace orrery::film {

struct LayerRequest;

/// The paths of a pixel whose first hit is a given sphere, or one that LayerRequest::coverage_key() replaces by it.
struct SphereCoverage {
  std::uint32_t sphere = kernel::kNone;
  std::int64_t weight = 0;  ///< number of paths
  // Only for deep images:
  kernel::Int128 light[3] = {0, 0, 0};
  double front = std::numeric_limits<double>::infinity();  ///< nearest entry of a path along the view axis
  double back = 0;                                         ///< farthest exit of a path along the view axis
};

/// The sums of all pixels that the requested layers need, besides the beauty and the denoiser guides; other arrays are
/// empty. They are integers, so that the order of addition does not change a bit.
struct LayerSums {
  using Channels = std::array<kernel::Int128, 3>;

  LayerSums() = default;
  LayerSums(const LayerRequest& request, std::size_t pixels);

  /// Adds a path of a pixel, except its light events. Radiance that is not finite or exceeds kernel::kLargestSample is
  /// invalid and excluded from all sums.
  void add(const LayerRequest& request, const kernel::SceneView& scene, std::size_t pixel,
           const kernel::PathRecord& path);

  /// Adds one of a path's light events. Ignored if the radiance of the path is invalid.
  ///
  /// Domain     request.lights()
  void add(const LayerRequest& request, std::size_t pixel, const kernel::PathRecord& path,
           const kernel::LightEvent& event);

  /// Adds further paths of the same pixels. If the nearest hits are at equal distances, that of this object is kept.
  ///
  /// Domain     the other has the same arrays
  void add(const LayerSums& other);

  base::ZeroVector<Channels> light;           ///< radiance: LayerRequest::light_cells() sums for each pixel
  base::ZeroVector<Channels> squares;         ///< squared radiance, in units of kSquareUnit
  base::ZeroVector<Channels> normal, albedo;  ///< at the first hits
  base::ZeroVector<std::int64_t> covered;     ///< coverage by what is not background, in units of kernel::kGuideUnit
  // The first hit nearest to the camera:
  base::ZeroVector<std::uint32_t> hit;  ///< id of its sphere plus 1; 0: there is none
  base::ZeroVector<double> depth;
  base::ZeroVector<float> z;  ///< depth along the view axis
  base::ZeroVector<std::array<float, 3>> position;
  /// Ascending by sphere, the background last; only for mattes and deep images.
  std::vector<std::vector<SphereCoverage>> shares;
};

/// Upper bound to which squared radiance is clamped: the sum over two halves of 2^31 paths still fits into 128 bits. A
/// variance that large is evident from the radiance itself.
inline constexpr double kLargestSquare = 0x1p47;
inline constexpr double kSquareUnit = 0x1p-48;

}  // namespace orrery::film
