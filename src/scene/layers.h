// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::scene {

/// Name in [output] that selects every layer of available_layers().
inline constexpr const char* kAllLayers = "all";

/// Returns why a scene cannot have a layer; empty if it can.
std::string layer_fault(const Scene& scene, const std::string& layer);

/// Returns the non-empty layers that a scene can have, in schema order.
std::vector<std::string> available_layers(const Scene& scene);

/// Returns the layers in [output], with kAllLayers expanded.
std::vector<std::string> requested_layers(const Scene& scene);

}  // namespace orrery::scene
