// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace orrery::load {

/// The OCIO config that a scene names, in the form of display::Settings; empty: none.
std::string config_of(const std::filesystem::path& scene_file, const scene::Color& color);

/// Converts all colours of a scene to its working space. Clamps reflectances to 0..1 and radiances to 0 or more.
///
/// `ocio`     OCIO config, in the form of display::Settings; not loaded if both spaces are the same
/// Result     number of clamped colours
/// Errors     those of display::convert_colors
int to_working_space(const std::string& ocio, scene::Scene& scene);

}  // namespace orrery::load
