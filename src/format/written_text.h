// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::format {

/// A scene file that orrery writes: the text, below a line with its checksum, by which check_unedited() recognises it.
std::string marked_text(const std::string& text);

/// Refuses to replace a file that orrery did not write, or that was edited since.
///
/// Errors     base::Error(kCannotCreate)
void check_unedited(const std::filesystem::path& file);

}  // namespace orrery::format
