// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::fuzz {

/// Each gives bytes to a reader and checks what must hold whatever they are: there is a scene that is fit to render, or
/// a base::Error with something to say; nothing else.
///
/// `folder` is for files, and may be used again.
///
/// Result     what does not hold, empty where all does; a crash is for the caller to see
std::string fault_with_scene(const std::filesystem::path& folder, const std::string& bytes);
std::string fault_with_ply(const std::filesystem::path& folder, const std::string& bytes);
/// The bytes are overrides, one a line.
std::string fault_with_overrides(const std::filesystem::path& folder, const std::string& bytes);

}  // namespace orrery::fuzz
