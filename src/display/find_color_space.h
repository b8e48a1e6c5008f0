// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "display/config.h"

namespace orrery::display {

/// Resolves a colour space given by name, alias or role to the config's canonical name. Spaces that orrery knows are
/// also found by the names that other configs use for them.
///
/// Errors     base::Error(kUsage) with all names tried, and similar names
std::string find_color_space(const Config& config, const std::string& name);

/// The same for a scene-linear space; data, log and display spaces are refused.
///
/// Errors     those of find_color_space; base::Error(kUsage) for a space that is not scene-linear
std::string find_scene_linear(const Config& config, const std::string& name);

}  // namespace orrery::display
