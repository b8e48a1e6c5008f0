// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace orrery::film {

/// A Cryptomatte layer: maps every sphere to the hash of its object, material or group name.
struct Matte {
  std::string name;                                                 ///< "CryptoObject"
  std::function<std::uint32_t(std::uint32_t sphere)> id_of_sphere;  ///< 0: the sphere is not in this matte
};

/// The layers (AOVs) to render in addition to the beauty; docs/output.md defines each.
struct LayerRequest {
  bool z = false, depth = false, normal = false, position = false, albedo = false;
  bool diffuse = false, specular = false, transmission = false, background = false;
  bool variance = false, samples = false, object_id = false, material_id = false;
  bool guide_albedo = false, guide_normal = false;
  bool coverage = false;                        ///< A is the fraction of the pixel that spheres cover, not 1
  bool deep = false;                            ///< also render a deep image
  int matte_ranks = 6;                          ///< maximum number of ids per pixel in a matte
  std::vector<std::uint32_t> material_numbers;  ///< material_id of each material of the compiled scene
  std::vector<Matte> mattes;

  bool lights() const { return diffuse || specular || transmission || background; }
  bool nearest() const { return z || depth || position || object_id || material_id; }
  bool paths_light() const { return lights() || variance || samples || deep; }
  bool guides() const { return guide_albedo || guide_normal; }
  bool any() const {
    return lights() || nearest() || normal || albedo || variance || samples || guide_albedo || guide_normal ||
           coverage || deep || !mattes.empty();
  }
};

/// Z and depth of a pixel without a hit: beyond every scene, and finite so that image filters do not produce NaN.
inline constexpr float kNothingHit = 1e30f;

}  // namespace orrery::film
