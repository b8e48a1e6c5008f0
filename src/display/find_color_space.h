// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "display/config.h"

namespace orrery::display {

/// The config's own name of a colour space: by its name, an alias or a role; and of the spaces that orrery knows, by
/// what other configs call them.
///
/// Errors     base::Error(kUsage) with all that was tried, and near names
std::string find_color_space(const Config& config, const std::string& name);

/// The same of a space in which light can be added up: not of data, of a camera's logarithm or of a display.
///
/// Errors     as find_color_space; base::Error(kUsage) for a space that is not scene-linear
std::string find_scene_linear(const Config& config, const std::string& name);

}  // namespace orrery::display
