// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "film/layers.h"
#include "kernel/path_record.h"
#include "kernel/pixel_sum.h"
#include "kernel/scene_view.h"

namespace orrery::film {

/// Paths of a pixel that met one sphere first.
struct SphereCoverage {
  std::uint32_t sphere = kernel::kNoSphere;
  std::int64_t weight = 0;
  // What follows is kept for deep pictures only.
  kernel::Int128 light[3] = {0, 0, 0};
  double front = std::numeric_limits<double>::infinity();  ///< nearest entry of a path, along the view
  double back = 0;                                         ///< farthest exit
};

/// What the paths of one pixel say about its layers, in whole numbers, so that no order of adding changes a bit.
struct LayerPixel {
  /// Adds a path; light that is no number enters no sum.
  void add(const LayerRequest& request, const kernel::SceneView& scene, const kernel::PathRecord& path,
           std::int64_t weight);

  /// Adds the paths of another part of the same pixel. Of two that met spheres equally near the first stays.
  void add(const LayerPixel& other);

  using Int128 = kernel::Int128;
  Int128 light[kernel::kLightGroups][3] = {};
  Int128 squares[3] = {};  ///< of the light, in units of kSquareUnit
  /// Light, without its sign, and squares of the paths whose weight is negative; for the variance only.
  Int128 negative_light[3] = {}, negative_squares[3] = {};
  Int128 normal[3] = {}, albedo[3] = {}, guide_albedo[3] = {}, guide_normal[3] = {};
  std::int64_t weight = 0;   ///< of all paths; 1 each unless the pixel filter has negative lobes
  std::int64_t lit = 0;      ///< of those whose light is a number
  std::int64_t paths = 0;    ///< whose light is a number, whatever their weight
  std::int64_t covered = 0;  ///< of those that met a sphere
  /// The path that met a sphere nearest to the camera.
  double depth = std::numeric_limits<double>::infinity(), z = 0;
  double position[3] = {0, 0, 0};
  std::uint32_t sphere = kernel::kNoSphere;
  std::vector<SphereCoverage> shares;  ///< by ascending sphere, the background last; only for mattes and deep pictures
};

/// Squares above 2^48 are cut to it: a variance that large is told by its light.
inline constexpr double kLargestSquare = 0x1p48;
inline constexpr double kSquareUnit = 0x1p-48;

}  // namespace orrery::film
