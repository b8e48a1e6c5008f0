// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "film/picture.h"

namespace orrery::image {

enum class Parts { kFirst, kAll };

/// Reads all channels of an image file as float planes, in any format that this room writes.
///
/// Of a multi-part EXR, the first part is read, or all parts that have its display window; a channel whose name occurs
/// in an earlier part is then named PART.CHANNEL. The result covers the display window: a smaller data window is padded
/// with zeros, a larger one is cropped. Integers of display formats are scaled to 0..1 and stay display-encoded;
/// integers of EXR keep their values.
///
/// `memory_limit`  maximum size of the planes, bytes; 0: none. The whole display window takes memory, even where the
///                 file has no pixels
/// Errors          base::Error: kUsage for an unknown extension, kMissingInput if the file cannot be opened, kBadData
///                 if it is not of the format of its extension, truncated or too large, kNoMemory
film::Picture read(const std::filesystem::path& file, Parts parts = Parts::kFirst, std::uint64_t memory_limit = 0);

}  // namespace orrery::image
