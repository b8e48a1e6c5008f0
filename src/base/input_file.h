// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::base {

/// Checks that an input is a readable regular file. Directories, devices and pipes are refused: inputs are read more
/// than once, and a pipe without a writer would block.
///
/// Errors     base::Error(kMissingInput) with the file and the reason
void require_readable(const std::filesystem::path& file);

/// Identifies a file and its contents by its absolute name, size and modification time. Equal texts: the contents that
/// were read have not changed since.
///
/// Result     of a file that cannot be examined, its name only
std::string file_version(const std::filesystem::path& file);

}  // namespace orrery::base
