// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace orrery::film {

/// A Cryptomatte layer: which spheres are one thing, by the hash of its name.
struct Matte {
  std::string name;                                                 ///< "CryptoObject"
  std::function<std::uint32_t(std::uint32_t sphere)> id_of_sphere;  ///< 0: of a sphere that is none of its things
};

/// The layers that a picture shall have beside its beauty; docs/output.md says what each holds.
struct LayerRequest {
  bool z = false, depth = false, normal = false, position = false, albedo = false;
  bool diffuse = false, specular = false, transmission = false, background = false;
  bool variance = false, samples = false, object_id = false, material_id = false;
  bool guide_albedo = false, guide_normal = false;
  bool coverage = false;                        ///< A is the share of the pixel that spheres cover, not 1
  bool deep = false;                            ///< a picture of samples in depth, beside the flat one
  int matte_ranks = 6;                          ///< things in a pixel that a matte tells apart
  std::vector<std::uint32_t> material_numbers;  ///< what material_id tells, by the compiled scene's materials
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

/// What stands in Z and depth where nothing was hit: beyond every scene, and finite, so that filters survive it.
inline constexpr float kNothingHit = 1e30f;

}  // namespace orrery::film
