// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "compile/forward.h"
#include "film/layers.h"
#include "image/header.h"
#include "scene/forward.h"

namespace orrery::job {

/// The layers that are Cryptomattes.
inline constexpr std::array kMatteLayers = {"CryptoObject", "CryptoMaterial", "CryptoGroup"};

/// The names in a Cryptomatte, as stored in its EXR header.
struct MatteNames {
  std::string layer;                                          ///< "CryptoObject"
  std::vector<std::pair<std::string, std::uint32_t>> things;  ///< unique names and their ids
};

/// The layers that a scene requests.
struct Layers {
  film::LayerRequest request;
  std::vector<MatteNames> mattes;  ///< one for each matte of the request
};

/// Returns the layer request and the mattes for the names in [output]. CryptoGroup is empty for a scene without groups.
///
/// `may_have_looks`  the display transform may need the coverage of objects in front of a backdrop
/// Domain     the scene is valid; `compiled` was compiled from it
Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled, bool may_have_looks = false);

/// The object of the CryptoObject matte that each sphere and each half of a rod belongs to, as a number.
///
/// Domain     as choose_layers()
base::PackedArray object_classes(const scene::Scene& scene, const compile::CompiledScene& compiled);

/// The header attributes of Cryptomattes: layer name, hash, conversion and manifest.
///
/// Cost       proportional to the number of names
/// Reference  cryptomatte-1.2
std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes);

}  // namespace orrery::job
