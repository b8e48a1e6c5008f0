// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "format/overrides.h"

namespace orrery::format {

/// Returns a scene file with its overrides applied: all keys in the order of the file, then those that only overrides
/// set. Materials keep their indices. Comments are lost.
///
/// `name`     name of the scene, for messages
/// `renamed`  returns the new name of a file that the scene names: data files, colour maps, backgrounds, OCIO configs
/// Errors     base::Error(kBadData) if the text is not TOML or an override is invalid; values are not checked
std::string merged_text(const std::filesystem::path& name, const std::string& text, const Overrides& overrides,
                        const std::function<std::string(const std::string& file)>& renamed);

}  // namespace orrery::format
