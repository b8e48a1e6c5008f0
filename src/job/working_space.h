// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace orrery::job {

/// The OCIO config that a scene names, as display::Settings has it; empty: none.
std::string config_of(const std::filesystem::path& scene_file, const scene::Color& color);

/// Brings all colours of a scene into its working space. A reflectance that is beyond 0..1 there, and light below 0,
/// become the nearest that a surface and a sky can have.
///
/// `ocio` is an OCIO config's file as display::Settings has it. Where both spaces are the same nothing is looked up.
///
/// Result     colours that had to be moved
/// Errors     base::Error, as display::convert_colors
int to_working_space(const std::string& ocio, scene::Scene& scene);

}  // namespace orrery::job
