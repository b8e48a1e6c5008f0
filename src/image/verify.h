// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::image {

/// Decodes all pixels of all parts of a picture, and tells the stamp that Header::stamp has left in it.
///
/// Result     the stamp; empty where the file is missing, is no whole picture, or has none
std::string verified_stamp(const std::filesystem::path& file);

}  // namespace orrery::image
