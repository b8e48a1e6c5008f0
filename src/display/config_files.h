// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::display {

/// The files that load_config() may open: the given config and the one in $OCIO, if they are files.
std::vector<std::filesystem::path> config_files(const std::string& config);

/// The LUT files that any transform of a config refers to.
///
/// Result     files that exist; empty if the config cannot be loaded, which load_config() reports
/// Cost       loads the config, but not the LUTs
std::vector<std::filesystem::path> table_files(const std::filesystem::path& config);

}  // namespace orrery::display
