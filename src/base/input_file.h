// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace orrery::base {

/// Checks that an input is a readable regular file. Directories, devices and pipes are refused: inputs are read more
/// than once, and a pipe without a writer would block.
///
/// Errors     base::Error(kMissingInput) with the file and the reason
void require_readable(const std::filesystem::path& file);

}  // namespace orrery::base
