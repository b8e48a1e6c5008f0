// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "film/picture.h"

namespace orrery::image {

enum class Parts { kFirst, kAll };

/// Reads all channels of an image file as float planes, in any format that this room writes.
///
/// Of a multi-part EXR, the first part is read, or all parts that have its display window; a channel whose name an
/// earlier part has is then named PART.CHANNEL. The result covers the display window: a smaller data window is
/// padded with zeros, a larger one is cropped. Integers of display formats are scaled to 0..1 and stay
/// display-encoded; integers of EXR keep their values.
///
/// Errors     base::Error: kUsage for an unknown extension, kMissingInput if the file cannot be opened, kBadData if it
///            is not of the format of its extension, truncated or too large
film::Picture read(const std::filesystem::path& file, Parts parts = Parts::kFirst);

}  // namespace orrery::image
