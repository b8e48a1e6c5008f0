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

}  // namespace orrery::display
