// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::display {

/// The files that load_config() may open: the given config and that of $OCIO, if these are files.
std::vector<std::filesystem::path> config_files(const std::string& config);

}  // namespace orrery::display
