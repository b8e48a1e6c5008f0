// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "format/read_keys.h"
#include "scene/scene.h"

namespace orrery::format {

/// Reads [material.NAME] tables, in the order of the file: data files count materials. Those that only an override
/// makes come behind. A material that is wrong is there too, by its name, so that one mistake is one finding.
void read_materials(Reading& reading, const toml::table& root, std::vector<scene::Material>& materials);

}  // namespace orrery::format
