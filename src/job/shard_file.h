// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "image/provenance.h"

namespace orrery::job {

/// An EXR with a shard of an image, and its provenance.
struct ShardFile {
  std::filesystem::path file;
  image::Provenance provenance;
};

}  // namespace orrery::job
