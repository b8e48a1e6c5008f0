// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace orrery::image {

/// Appends a digest of all bytes of a file, behind the end at which picture programs stop reading: a change of any bit
/// is noticed, also of one that no decoder looks at. It protects from accidents, not from forgers.
///
/// Source     SHA-1, FIPS 180-4
/// Errors     base::Error(kIo); `name` is what the file is called in the message
void seal(const std::filesystem::path& file, const std::filesystem::path& name);

/// Errors     base::Error: kMissingInput where it cannot be opened, kBadData where it has no seal, or one that does not
///            fit
void require_seal(const std::filesystem::path& file);

}  // namespace orrery::image
