// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "image/format.h"

namespace orrery::image {

/// Looks for damage that the libraries do not report, or report on standard error: PNG files that are truncated or
/// whose checksums do not match, and truncated JPEG files, whose missing rows libjpeg fills with grey. Pixels are not
/// decoded.
///
/// Result     what is wrong; empty if nothing was found, for other formats, and for a file whose format does not match
///            its name
std::string damage_of(const std::filesystem::path& file, Format format);

}  // namespace orrery::image
