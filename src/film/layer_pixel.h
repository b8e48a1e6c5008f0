// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

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

/// Layer sums of one pixel, without denoiser guides. They are integers, so that the order of addition does not change a
/// bit.
struct LayerPixel {
  /// Adds a path, except its light events. Radiance that is not finite or exceeds kernel::kLargestSample is invalid and
  /// excluded from all sums.
  void add(const LayerRequest& request, const kernel::SceneView& scene, const kernel::PathRecord& path);

  /// Adds one of a path's light events. Ignored if the radiance of the path is invalid.
  ///
  /// Domain     request.lights()
  void add(const LayerRequest& request, const kernel::PathRecord& path, const kernel::LightEvent& event);

  /// Adds further paths of the same pixel. If the nearest hits are at equal distances, that of this object is kept.
  void add(const LayerPixel& other);

  using Int128 = kernel::Int128;
  /// Sums of the radiance by LayerRequest::light_cell; empty if no light events were added.
  std::vector<std::array<Int128, 3>> light;
  Int128 squares[3] = {};  ///< sums of squared radiance, in units of kSquareUnit
  Int128 normal[3] = {}, albedo[3] = {};
  std::int64_t weight = 0;   ///< number of paths
  std::int64_t lit = 0;      ///< number of paths with valid radiance
  std::int64_t covered = 0;  ///< number of paths that hit a sphere
  /// The first hit nearest to the camera: distance, depth along the view axis, position and sphere.
  double depth = std::numeric_limits<double>::infinity(), z = 0;
  double position[3] = {0, 0, 0};
  std::uint32_t sphere = kernel::kNone;
  std::vector<SphereCoverage> shares;  ///< ascending by sphere, the background last; only for mattes and deep images
};

/// Sums over half of a pixel's paths.
struct HalfSums {
  kernel::PixelSum light;
  kernel::GuideSum guides;

  HalfSums& operator+=(const HalfSums& other) noexcept {
    light += other.light;
    guides += other.guides;
    return *this;
  }
};

/// Both halves of a pixel.
using Halves = std::array<HalfSums, 2>;

/// Upper bound to which squared radiance is clamped: the sum over two halves of 2^31 paths still fits into 128 bits. A
/// variance that large is evident from the radiance itself.
inline constexpr double kLargestSquare = 0x1p47;
inline constexpr double kSquareUnit = 0x1p-48;

/// The mean of fixed-point values from their sum and total weight; 0 without weight.
inline double mean(kernel::Int128 sum, std::int64_t weight) {
  return weight > 0 ? kernel::from_fixed_point(sum) / static_cast<double>(weight) : 0.0;
}

}  // namespace orrery::film
