// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::fuzz {

/// Passes bytes to a reader and checks its contract: it returns a valid scene or throws a base::Error with diagnostics.
///
/// `folder` receives temporary files and can be reused.
///
/// Result     description of the violation, empty if there is none; crashes are left to the caller
std::string fault_with_scene(const std::filesystem::path& folder, const std::string& bytes);
std::string fault_with_ply(const std::filesystem::path& folder, const std::string& bytes);
/// As above for data files of all formats: describes and reads up to three frames, and loads their spheres.
std::string fault_with_data(const std::filesystem::path& folder, const std::string& bytes);
/// As above for selections, which are evaluated on a small table.
std::string fault_with_selection(const std::filesystem::path& folder, const std::string& bytes);
/// As above for colour maps in files.
std::string fault_with_color_map(const std::filesystem::path& folder, const std::string& bytes);
/// As above for overrides, one per line.
std::string fault_with_overrides(const std::filesystem::path& folder, const std::string& bytes);

/// As above for the body of a request to `orrery view`, which becomes words of a command.
std::string fault_with_wish(const std::filesystem::path& folder, const std::string& bytes);

}  // namespace orrery::fuzz
