// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace orrery::image {

/// Appends a digest of all bytes of a file, after the end of the image data. It detects any changed bit, including bits
/// that no decoder reads. It protects against accidental damage, not against tampering.
///
/// Errors     base::Error(kIo); the message uses `name` for the file
/// Reference  SHA-1, FIPS 180-4
void append_digest(const std::filesystem::path& file, const std::filesystem::path& name);

/// Checks the digest of a file.
///
/// Errors     base::Error: kMissingInput if the file cannot be opened, kBadData if it has no digest or a wrong one
void require_digest(const std::filesystem::path& file);

}  // namespace orrery::image
