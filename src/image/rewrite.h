// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "film/picture.h"
#include "image/header.h"
#include "image/write.h"

namespace orrery::image {

/// Changes the values of planes. Must not change their number, names or sizes.
///
/// Result     attributes to add to the file
using EditPlanes = std::function<std::vector<Attribute>(film::Picture& planes)>;

/// Report of rewrite_exr().
struct RewriteReport {
  std::uint64_t clamped = 0;             ///< values that were clamped to the range of half
  std::vector<std::string> other_parts;  ///< names of further parts with a channel R, which were copied
  bool had_attributes = false;           ///< the file already had an attribute that `edit` adds
};

/// Copies an EXR with changed pixels. Parts, windows, channels, pixel types, compression and attributes are kept,
/// except the stamp, which no longer describes the pixels. Integer channels are copied.
///
/// The planes are the floating-point channels of all parts that have the data window of the first, by name. A channel
/// whose name occurs in an earlier part is named PART.CHANNEL.
///
/// Errors     base::Error: kUsage if a file is not an EXR, kMissingInput, kBadData if the input is damaged, deep, or a
///            shard or checkpoint, kCannotCreate, kIo; those of `edit`. An existing output is then unchanged
RewriteReport rewrite_exr(const std::filesystem::path& input, const std::filesystem::path& output,
                          const EditPlanes& edit);

}  // namespace orrery::image
