// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::scene {

/// Name in [output] that selects every layer of available_layers().
inline constexpr const char* kAllLayers = "all";

/// Name in [output] of the layer for denoising, which kAllLayers does not include.
inline constexpr const char* kHalvesLayer = "halves";

/// Name in [output] of the layer of motion vectors.
inline constexpr const char* kVectorLayer = "Vector";

/// Returns the names of all layers, in the order of the documentation.
const std::vector<std::string>& layer_names();

/// Light group of emitters and backgrounds that name none. May also be named explicitly.
inline constexpr const char* kDefaultLightGroup = "default";

/// Returns the name of the light group that the background belongs to. Gradients and constant colours have no key for
/// it and belong to the default group.
std::string background_light_group(const Background& background);

/// Returns why a name is invalid for a light group; empty if it is valid.
std::string light_group_fault(const std::string& name);

/// Returns why a scene cannot have a layer; empty if it can.
std::string layer_fault(const Scene& scene, const std::string& layer);

/// Returns the non-empty layers that a scene can have, in the order of layer_names().
std::vector<std::string> available_layers(const Scene& scene);

/// Returns the layers in [output], with kAllLayers expanded.
std::vector<std::string> requested_layers(const Scene& scene);

}  // namespace orrery::scene
