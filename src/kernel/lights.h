// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "math/vec3.h"

namespace orrery::kernel {

/// Sampling of direct light at non-delta vertices.
enum class DirectLighting : std::uint8_t {
  kMis,    ///< light and BSDF sampling, weighted by the power heuristic
  kBsdf,   ///< BSDF sampling only
  kLight,  ///< light sampling only, wherever the light can be sampled
};

/// A bounding sphere of emitters and their power. Centre and radius are loaded as four doubles.
struct LightNode {
  double center[3];
  double radius;
  double power;  ///< radiance, summed over the channels, times radius^2, summed over the emitters
};

/// A range of leaves of the light tree.
struct LightRange {
  std::uint32_t begin, end;
};

/// The emitters, spheres and halves of rods, as leaves of an implicit balanced tree: a range of leaves is split in the
/// middle, down to single leaves. Up to kFew emitters form a list instead. Non-owning.
struct Lights {
  static constexpr std::uint32_t kNoLeaf = 0xffffffffu;
  /// Maximum number of emitters that are sampled from a list (measured: docs/decisions/0022-direct-lighting.md).
  static constexpr std::uint32_t kFew = 64;

  const std::uint32_t* spheres = nullptr;  ///< object id of each leaf
  /// Nodes of the tree: that of a range of two or more leaves is at its `middle`. For a list, one node per leaf.
  const LightNode* nodes = nullptr;
  const std::uint32_t* leaves = nullptr;  ///< by ascending object id
  std::uint32_t count = 0;                ///< leaves; 0: no emitter is sampled

  bool few() const noexcept { return count <= kFew; }
  static std::uint32_t middle(LightRange r) noexcept { return r.begin + (r.end - r.begin) / 2; }
  /// The leaf of an object, or kNoLeaf.
  std::uint32_t leaf(std::uint32_t sphere) const noexcept {
    const std::uint32_t* const found = std::lower_bound(
        leaves, leaves + count, sphere, [&](std::uint32_t at, std::uint32_t id) { return spheres[at] < id; });
    return found != leaves + count && spheres[*found] == sphere ? *found : kNoLeaf;
  }
};

/// A level of the sums from which cells are sampled: the four children of a node in consecutive floats, upper left,
/// upper right, lower left, lower right. Children outside the map are zero.
struct EnvironmentLevel {
  const float* blocks = nullptr;
  std::uint32_t blocks_per_row = 0;
};

/// A row of cells. The versine is 1 - cos of the angle to the nearer pole.
struct EnvironmentRow {
  double versine = 0;  ///< versine at the row's upper edge
  double width = 0;    ///< difference to the lower edge: positive in the upper half of the map, negative in the lower
};

/// Non-owning view of an image background for the kernel: a latitude-longitude map, and optionally the sun.
///
/// Rows go from +y to -y, and edges of texels lie on the poles. Longitude 0 is +z, a quarter turn is +x; it decreases
/// from half a turn at the left edge to minus half a turn at the right.
///
/// Directions are sampled with a density proportional to the bilinear interpolation of weights at the texels' centres,
/// max(weight_scale (r + g + b) - weight_offset, 0). Within a cell, the quadrilateral between four neighbouring
/// centres, the interpolation is linear in the longitude and in the cosine to the pole. Cells of the first and the last
/// row extend to the poles; there, weights depend on the longitude only.
///
/// Reference  docs/decisions/0023
struct Environment {
  static constexpr std::size_t kMaxLevels = 17;

  const float* texels = nullptr;  ///< R, G, B; rows from the top; one more float at the end can be read
  std::uint32_t width = 0;        ///< texels
  std::uint32_t height = 0;       ///< texels
  double scale = 1;               ///< exposure: multiplies the texels
  double turn = 0;                ///< rotation about +y, turns, 0..1

  math::Vec3d sun{0, 1, 0};  ///< unit direction to the centre of the sun
  math::Vec3d sun_tangent{1, 0, 0}, sun_bitangent{0, 0, 1};
  double sun_one_minus_cos = 0;  ///< 1 - cos of half the angle that the sun subtends
  math::Vec3d sun_radiance;      ///< added to the map's; exposure is applied
  bool has_sun = false;

  bool is_sampled = false;     ///< false: light sampling would not help, and sample_environment is undefined
  double sun_probability = 0;  ///< probability of sampling the sun instead of the map
  double sun_density = 0;      ///< density of directions in the sun's cone, per steradian
  double map_density = 0;      ///< per steradian and unit of interpolated weight; 0: the map is not sampled
  double weight_scale = 0, weight_offset = 0;
  const EnvironmentRow* rows = nullptr;  ///< height + 1 rows of cells, and a row of width 0 if that makes them even
  EnvironmentLevel levels[kMaxLevels];   ///< from the root down; the cells themselves are computed from the texels
  std::uint32_t level_count = 0;

  std::uint16_t light_group = 0;
  bool visible = true;  ///< visible to the camera
  double power = 0;     ///< integral over all directions of the radiance's mean over the channels
};

}  // namespace orrery::kernel
