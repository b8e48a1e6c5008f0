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

  bool lights() const;                                        ///< any lobe AOV
  bool nearest() const;                                       ///< a property of the nearest hit
  bool paths_light() const;                                   ///< the radiance of single paths
  bool light_events() const { return lights() || variance; }  ///< the lobes that radiance came from
  bool guides() const;                                        ///< a guide for denoising
  bool any() const;
};

/// What a layer is computed from.
enum class LayerSource {
  kLight,    ///< radiance by lobe
  kNearest,  ///< the first hit nearest to the camera
  kSums,     ///< sums over first hits
  kPaths,    ///< number and radiance of the paths
  kGuide,    ///< sums over the first hits that are not delta distributions
};

/// A layer, except the Cryptomattes.
struct LayerType {
  const char* name;  ///< in [output] layers
  bool LayerRequest::*requested;
  LayerSource source;
};

/// All layers. The scene's schema lists the same names; layer_film.cpp computes the values.
inline constexpr LayerType kLayerTypes[] = {
    {"Z", &LayerRequest::z, LayerSource::kNearest},
    {"depth", &LayerRequest::depth, LayerSource::kNearest},
    {"N", &LayerRequest::normal, LayerSource::kSums},
    {"P", &LayerRequest::position, LayerSource::kNearest},
    {"albedo", &LayerRequest::albedo, LayerSource::kSums},
    {"diffuse", &LayerRequest::diffuse, LayerSource::kLight},
    {"specular", &LayerRequest::specular, LayerSource::kLight},
    {"transmission", &LayerRequest::transmission, LayerSource::kLight},
    {"background", &LayerRequest::background, LayerSource::kLight},
    {"variance", &LayerRequest::variance, LayerSource::kPaths},
    {"samples", &LayerRequest::samples, LayerSource::kPaths},
    {"object_id", &LayerRequest::object_id, LayerSource::kNearest},
    {"material_id", &LayerRequest::material_id, LayerSource::kNearest},
    {"denoise.albedo", &LayerRequest::guide_albedo, LayerSource::kGuide},
    {"denoise.normal", &LayerRequest::guide_normal, LayerSource::kGuide},
};

namespace detail {

constexpr bool requests(const LayerRequest& request, LayerSource source) {
  for (const LayerType& layer : kLayerTypes)
    if (layer.source == source && request.*layer.requested) return true;
  return false;
}

}  // namespace detail

inline bool LayerRequest::lights() const { return detail::requests(*this, LayerSource::kLight); }
inline bool LayerRequest::nearest() const { return detail::requests(*this, LayerSource::kNearest); }
inline bool LayerRequest::paths_light() const {
  return lights() || detail::requests(*this, LayerSource::kPaths) || deep;
}
inline bool LayerRequest::guides() const { return detail::requests(*this, LayerSource::kGuide); }
inline bool LayerRequest::any() const {
  return paths_light() || nearest() || guides() || detail::requests(*this, LayerSource::kSums) || coverage ||
         !mattes.empty();
}

/// Z and depth of a pixel without a hit: beyond every scene, and finite so that image filters do not produce NaN.
inline constexpr float kNothingHit = 1e30f;

}  // namespace orrery::film
