// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::scene {

/// The name in [output] that stands for every layer of available_layers().
inline constexpr const char* kAllLayers = "all";

/// Why a scene cannot have a layer; empty where it can.
std::string layer_fault(const Scene& scene, const std::string& layer);

/// The layers that a scene can have and that are not empty, in the order of the documentation.
std::vector<std::string> available_layers(const Scene& scene);

/// The layers in [output], with kAllLayers replaced.
std::vector<std::string> requested_layers(const Scene& scene);

}  // namespace orrery::scene
