// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "film/partial.h"
#include "film/picture.h"
#include "image/write.h"

namespace orrery::image {

/// What a partial's file says of where it comes from, by name: "sceneHash" as "0123456789abcdef".
using Provenance = std::map<std::string, std::string>;

/// Writes a partial as a sealed EXR of two parts: what can be seen of the picture so far, which any program opens, and
/// the exact sums.
///
/// `provenance` stands in the header as "orrery/partial/NAME"
/// Result     the file stands under its name whole and synced, or an error is thrown and nothing has changed
/// Errors     base::Error: kCannotCreate, kIo
void write_partial(const std::filesystem::path& file, const film::Picture& preview, const Header& header,
                   const Provenance& provenance, const film::Partial& partial);

/// What a partial's file says of itself. The seal is checked, the sums are not read.
///
/// Errors     as read_partial
Provenance read_provenance(const std::filesystem::path& file);

/// Both.
struct PartialFile {
  Provenance provenance;
  film::Partial partial;
};

/// Errors     base::Error: kMissingInput where it cannot be opened, kBadData where it is no whole, undamaged partial of
///            this size
PartialFile read_partial(const std::filesystem::path& file, int width_px, int height_px);

}  // namespace orrery::image
