// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "film/picture.h"

namespace orrery::image {

/// Reads all channels of a picture as float planes, of any format that this room writes.
///
/// Of an EXR with several parts it is the first. The picture is the display window: a smaller data window stands in
/// zeros, a larger one is cut. Whole numbers of display formats become 0..1, still encoded for their display; whole
/// numbers of EXR stay as they are.
///
/// Errors     base::Error: kUsage for an unknown extension, kMissingInput where it cannot be opened, kBadData where it
///            is no picture of its extension, is cut off or too large
film::Picture read(const std::filesystem::path& file);

}  // namespace orrery::image
