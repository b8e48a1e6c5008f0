// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace orrery::base {

/// Refuses an input that is missing, that may not be read, or that is not a regular file: a directory, a device or a
/// pipe. Inputs are read more than once, and a pipe without a writer would block.
///
/// Errors     base::Error(kMissingInput) naming the file and the reason
void require_readable(const std::filesystem::path& file);

}  // namespace orrery::base
