// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "compile/world.h"
#include "film/layers.h"
#include "scene/scene.h"

namespace orrery::app {

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

/// Finds out what the names in [output] come to. Of a scene without groups CryptoGroup is empty.
///
/// Domain     the world was compiled from this scene, and outlives the result
/// Errors     base::Error(kBadData) for what the scene cannot give: light by surface without light paths, more spheres
///            than a float counts
Layers choose_layers(const scene::Scene& scene, const compile::World& world);

}  // namespace orrery::app
