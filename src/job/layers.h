// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "scene/scene.h"

namespace orrery::job {

/// A Cryptomatte as its header tells it: what the things are called.
struct MatteNames {
  std::string layer;                                          ///< "CryptoObject"
  std::vector<std::pair<std::string, std::uint32_t>> things;  ///< names and their ids, each once
};

/// The layers that a scene asks for.
struct Layers {
  film::LayerRequest request;
  std::vector<MatteNames> mattes;  ///< one for each of the request
};

/// The request and the mattes for the names in [output]. Of a scene without groups CryptoGroup is empty.
///
/// Domain     the scene is valid, the world was compiled from it and outlives the result
Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled);

}  // namespace orrery::job
