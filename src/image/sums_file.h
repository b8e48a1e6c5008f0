// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "film/forward.h"
#include "film/sums.h"
#include "image/header.h"

namespace orrery::image {

struct Header;

/// Prefix of the attributes that distinguish shards and checkpoints from images.
inline constexpr const char* kSumsPrefix = "orrery/partial/";

/// Writes a checkpoint or shard as a two-part EXR with a digest: a preview image that any program opens, and the exact
/// sums. `provenance` is stored in the header as "orrery/partial/NAME".
///
/// Result     the file is complete and synced, or an error is thrown and an existing file is unchanged
/// Errors     base::Error: kCannotCreate, kIo
void write_sums(const std::filesystem::path& file, const film::Picture& preview, const Header& header,
                const Provenance& provenance, const film::Sums& sums);

/// Reads the provenance of a checkpoint or shard, but neither its digest nor its sums, which may be damaged.
///
/// Errors     base::Error: kMissingInput if it cannot be opened, kBadData if it is no checkpoint or shard
Provenance read_provenance(const std::filesystem::path& file);

/// Content of a checkpoint or shard.
struct SumsFile {
  Provenance provenance;
  film::Sums sums;
};

/// Reads a checkpoint or shard.
///
/// `check`    called before the sums are read; throws if they are not wanted
/// Errors     base::Error: kMissingInput if it cannot be opened, kBadData if it is not a complete, undamaged checkpoint
///            or shard of this size; those of `check`
SumsFile read_sums(const std::filesystem::path& file, int width_px, int height_px,
                   const std::function<void(const Provenance&)>& check = nullptr);

}  // namespace orrery::image
