// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::display {

/// The files that load_config() may open: the given config and that of $OCIO, if these are files.
std::vector<std::filesystem::path> config_files(const std::string& config);

/// The LUT files that the transforms of a config name, whichever view uses them.
///
/// Result     empty if the config cannot be loaded, which load_config() reports; without files that do not exist
/// Cost       loads the config, but not the LUTs
std::vector<std::filesystem::path> table_files(const std::filesystem::path& config);

}  // namespace orrery::display
