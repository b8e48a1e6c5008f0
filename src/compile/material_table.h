// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "compile/forward.h"
#include "math/vec3.h"
#include "scene/forward.h"

namespace orrery::compile {

/// Returns 2^stops.
///
/// Precision  rounded from long double, so that it does not depend on the math library
double stops_to_factor(double stops);

/// Returns the index of a light group; adds the group if it is new.
std::uint16_t light_group(CompiledScene& compiled, const std::string& name);

/// Compiles materials on first use, so that unused ones are left out.
class MaterialTable {
 public:
  /// A table that compiles materials of `scene` into `compiled`.
  ///
  /// Domain     `scene` and `compiled` outlive it
  MaterialTable(const scene::Scene& scene, CompiledScene& compiled);

  /// Returns the index of a material for spheres whose normals point outward or inward.
  std::uint32_t index(std::uint32_t authored, bool inside_out);

  /// Returns the index of a material whose colour is replaced by one of a palette.
  ///
  /// `points`   index of the points table that the palette belongs to; the spheres of a table are consecutive
  std::uint32_t colored_index(std::uint32_t authored, bool inside_out, std::size_t points, std::uint16_t color,
                              math::Vec3d rgb);

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  const scene::Scene& scene_;
  CompiledScene& out_;
  std::vector<std::array<std::uint32_t, 2>> compiled_;
  std::size_t points_ = 0;
  std::unordered_map<std::uint64_t, std::uint32_t>
      colored_;  ///< indices for one points table, by base material and colour
};

}  // namespace orrery::compile
