// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::image {

/// Decodes all pixels of all parts of an image file and returns its stamp (Header::stamp).
///
/// Result     empty if the file is missing, incomplete or has no stamp
std::string verified_stamp(const std::filesystem::path& file);

}  // namespace orrery::image
