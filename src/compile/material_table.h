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
#include "scene/scene.h"

namespace orrery::compile {

/// Returns 2^stops.
///
/// Precision  rounded from long double, so that it does not depend on the math library
double stops_to_factor(double stops);

/// Returns the index of a light group; adds the group if it is new.
std::uint16_t light_group(CompiledScene& compiled, const std::string& name);

/// Origin of a compiled material. It stays the same while only the values of materials and palettes change.
struct MaterialSource {
  static constexpr std::uint32_t kNoColor = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t material = 0;      ///< index into scene::Scene::materials; of a coloured one: of the compiled materials
  bool inside_out = false;         ///< for spheres whose normals point inward
  std::uint32_t points = 0;        ///< points table that the palette belongs to
  std::uint32_t color = kNoColor;  ///< index into the palette; kNoColor: not coloured
};

/// Numbers materials on first use, so that unused ones are left out.
class MaterialTable {
 public:
  /// A table that appends to `sources`.
  ///
  /// Domain     `scene` and `sources` outlive it
  MaterialTable(const scene::Scene& scene, std::vector<MaterialSource>& sources);

  /// Returns the index of a material for spheres whose normals point outward or inward.
  std::uint32_t index(std::uint32_t authored, bool inside_out);

  /// Returns the index of a material whose colour is replaced by one of a palette.
  ///
  /// `points`   index of the points table that the palette belongs to; the spheres of a table are consecutive
  std::uint32_t colored_index(std::uint32_t authored, bool inside_out, std::size_t points, std::uint16_t color);

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  bool is_dielectric(std::uint32_t authored) const;

  const scene::Scene& scene_;
  std::vector<MaterialSource>& sources_;
  std::vector<std::array<std::uint32_t, 2>> numbers_;
  std::size_t points_ = 0;
  std::unordered_map<std::uint64_t, std::uint32_t>
      colored_;  ///< indices for one points table, by base material and colour
};

/// Compiles the materials of `compiled.material_sources`, with their emission, textures and light groups, and the
/// features that they require.
void compile_materials(const scene::Scene& scene, CompiledScene& compiled);

}  // namespace orrery::compile
