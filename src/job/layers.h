// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "compile/forward.h"
#include "film/layers.h"
#include "job/matte_names.h"
#include "scene/forward.h"

namespace orrery::job {

/// The layers that are Cryptomattes.
inline constexpr std::array kMatteLayers = {"CryptoObject", "CryptoMaterial", "CryptoGroup"};

/// The layers that a scene requests.
struct Layers {
  film::LayerRequest request;
  std::vector<MatteNames> mattes;  ///< one for each matte of the request
};

/// Returns the layer request and the mattes for the names in [output]. CryptoGroup is empty for a scene without groups.
///
/// Domain     the scene is valid; `compiled` was compiled from it
Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled);

}  // namespace orrery::job
