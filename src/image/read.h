// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "film/picture.h"

namespace orrery::image {

/// Reads all channels of a picture's first part as float planes.
///
/// Errors     base::Error: kMissingInput where it cannot be opened, kBadData where it is no picture or is cut off
film::Picture read(const std::filesystem::path& file);

}  // namespace orrery::image
