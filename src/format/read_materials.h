// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <vector>

#include "scene/scene.h"

namespace orrery::format {

struct ReadState;

/// Reads the [material.NAME] tables in the order of the file, which defines the material indices of points files.
/// Materials that only overrides define follow. An invalid material keeps its name and index, so that spheres that use
/// it cause no further errors.
void read_materials(ReadState& state, const toml::table& root, std::vector<scene::Material>& materials);

/// Removes the keys of a material or texture that only its type in the file has, if an override has replaced the type.
void drop_keys_of_old_types(toml::table& root);

}  // namespace orrery::format
