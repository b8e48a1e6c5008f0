// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "film/motion_vectors.h"
#include "kernel/path_record.h"

namespace orrery::film {

/// The name of each lobe's layer, indexed by kernel::Lobe.
inline constexpr const char* kLobeNames[kernel::kLobes] = {
    "background",        "diffuse_direct",      "diffuse_indirect",      "specular_direct",
    "specular_indirect", "transmission_direct", "transmission_indirect", "emission"};

/// A light group of the scene. The members describe its sources, not their radiance, so that all frames of a sequence
/// have the same layers even if a light is black in some of them.
struct LightGroup {
  std::string name;             ///< prefix of the names of its layers
  bool has_emitters = false;    ///< spheres emit its light
  bool has_background = false;  ///< the background emits its light

  bool has_sources() const { return has_emitters || has_background; }
  /// Returns whether the group has a layer for this lobe.
  bool has(kernel::Lobe lobe) const {
    if (lobe == kernel::Lobe::kEmission) return has_emitters;
    if (lobe == kernel::Lobe::kBackground) return has_background;
    return has_sources();
  }
};

/// The spheres in classes, each of spheres that have the same ids in all mattes.
struct MatteClasses {
  base::PackedArray of_sphere;
  std::vector<std::uint32_t> first_sphere;  ///< of each class
};

/// A Cryptomatte layer: the hash of an object, material or group name.
struct Matte {
  std::string name;                ///< "CryptoObject"
  std::vector<std::uint32_t> ids;  ///< of each class of spheres; 0: it is not in this matte
};

/// The layers (AOVs) to render in addition to the beauty; docs/output.md defines each.
struct LayerRequest {
  bool z = false, depth = false, normal = false, position = false, albedo = false;
  bool diffuse = false, specular = false, transmission = false, background = false, emission = false;
  bool light_groups = false;
  bool variance = false, samples = false, object_id = false, material_id = false, vector = false;
  bool guide_albedo = false, guide_normal = false;
  bool halves = false;       ///< beauty and guides of two halves of the samples, for denoising
  bool coverage = false;     ///< the fraction of the pixel that is not background, for display or as A
  bool transparent = false;  ///< that fraction is A, which otherwise is 1, and the background is black; with `coverage`
  bool deep = false;         ///< also render a deep image
  int matte_ranks = 6;       ///< maximum number of ids per pixel in a matte
  std::vector<std::uint32_t> material_numbers;  ///< material_id of each material of the compiled scene
  std::vector<LightGroup> groups;               ///< light groups of the scene, indexed by kernel::LightEvent::group
  std::vector<Matte> mattes;
  std::shared_ptr<const MatteClasses> matte_classes;  ///< null without mattes
  NeighborFrames neighbors;                           ///< for `vector`

  /// The id of a sphere in a matte of this request.
  std::uint32_t matte_id(const Matte& matte, std::uint32_t sphere) const {
    return matte.ids[matte_classes->of_sphere[sphere]];
  }
  /// The sphere that stands for this one in the coverage of a pixel. A deep image needs each sphere by itself, mattes
  /// only the first of its class.
  std::uint32_t coverage_key(std::uint32_t sphere) const {
    return deep ? sphere : matte_classes->first_sphere[matte_classes->of_sphere[sphere]];
  }
  bool lights() const;   ///< true if a layer needs radiance by lobe or light group, from light events
  bool hits() const;     ///< true if a layer needs the first hits of individual paths
  bool nearest() const;  ///< true if a layer needs a property of the nearest hit
  bool paths() const;    ///< true if a layer needs the number or radiance of the paths
  bool paths_light() const { return lights() || paths() || deep; }  ///< the radiance of single paths
  bool path_records() const { return hits() || paths(); }           ///< sums over records of single paths
  bool records() const { return lights() || path_records(); }       ///< layers made from records or light events
  bool guides() const;                                              ///< sums of guides for denoising
  bool any() const { return records() || guides() || coverage; }

  /// Number of sums that a pixel's light is divided into: one per lobe, or one per lobe and light group.
  std::size_t light_cells() const;
  /// Index of the sum that a light event belongs to.
  ///
  /// `group`    kernel::LightEvent::group
  std::size_t light_cell(std::size_t group, kernel::Lobe lobe) const {
    return (light_groups ? group : std::size_t{0}) * kernel::kLobes + static_cast<std::size_t>(lobe);
  }
};

/// Source of the values of a layer.
enum class LayerSource {
  kLight,    ///< radiance by lobe or light group
  kNearest,  ///< the first hit nearest to the camera
  kSums,     ///< sums over first hits
  kPaths,    ///< number and radiance of the paths
  kGuide,    ///< sums over the first hits that are not delta distributions
  kHalves,   ///< radiance and guides of each half of the samples
};

/// A layer, except the Cryptomattes.
struct LayerType {
  const char* name;  ///< in [output] layers
  bool LayerRequest::*requested;
  LayerSource source;
};

/// All layers. The scene's schema lists the same names; layer_planes.cpp computes the values.
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
    {"emission", &LayerRequest::emission, LayerSource::kLight},
    {"light_groups", &LayerRequest::light_groups, LayerSource::kLight},
    {"variance", &LayerRequest::variance, LayerSource::kPaths},
    {"samples", &LayerRequest::samples, LayerSource::kPaths},
    {"object_id", &LayerRequest::object_id, LayerSource::kNearest},
    {"material_id", &LayerRequest::material_id, LayerSource::kNearest},
    {"Vector", &LayerRequest::vector, LayerSource::kNearest},
    {"denoise.albedo", &LayerRequest::guide_albedo, LayerSource::kGuide},
    {"denoise.normal", &LayerRequest::guide_normal, LayerSource::kGuide},
    {"halves", &LayerRequest::halves, LayerSource::kHalves},
};

namespace detail {

/// Returns whether layers of a source are requested. Called per path; the table is evaluated at compile time.
template <LayerSource kSource, std::size_t... kIndices>
constexpr bool requests(const LayerRequest& request, std::index_sequence<kIndices...>) {
  return ((kLayerTypes[kIndices].source == kSource && request.*kLayerTypes[kIndices].requested) || ...);
}
template <LayerSource kSource>
constexpr bool requests(const LayerRequest& request) {
  return requests<kSource>(request, std::make_index_sequence<std::size(kLayerTypes)>());
}

}  // namespace detail

inline bool LayerRequest::lights() const { return detail::requests<LayerSource::kLight>(*this); }
inline bool LayerRequest::nearest() const { return detail::requests<LayerSource::kNearest>(*this); }
inline bool LayerRequest::paths() const { return detail::requests<LayerSource::kPaths>(*this); }
inline bool LayerRequest::hits() const {
  return nearest() || detail::requests<LayerSource::kSums>(*this) || deep || !mattes.empty();
}
inline bool LayerRequest::guides() const {
  return detail::requests<LayerSource::kGuide>(*this) || detail::requests<LayerSource::kHalves>(*this);
}
inline std::size_t LayerRequest::light_cells() const {
  return lights() ? (light_groups ? groups.size() : 1) * kernel::kLobes : 0;
}

/// Z and depth of a pixel without a hit: beyond every scene, and finite so that image filters do not produce NaN.
inline constexpr float kNothingHit = 1e30f;

}  // namespace orrery::film
