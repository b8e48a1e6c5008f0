// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "scene/scene.h"

namespace orrery::job {

/// The layers that are Cryptomattes.
inline constexpr std::array kMatteLayers = {"CryptoObject", "CryptoMaterial", "CryptoGroup"};

/// A Cryptomatte's names, as in its EXR header.
struct MatteNames {
  std::string layer;                                          ///< "CryptoObject"
  std::vector<std::pair<std::string, std::uint32_t>> things;  ///< unique names and their ids
};

/// The layers that a scene requests.
struct Layers {
  film::LayerRequest request;
  std::vector<MatteNames> mattes;  ///< one for each matte of the request
};

/// The layer request and the mattes for the names in [output]. CryptoGroup is empty for a scene without groups.
///
/// Domain     the scene is valid; `compiled` was compiled from it and outlives the result
Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled);

}  // namespace orrery::job
