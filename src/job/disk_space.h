// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>

#include "job/outputs.h"

namespace orrery::job {

/// What the size of an image's files depends on.
struct ImageSize {
  int width_px = 0, height_px = 0;
  std::size_t layer_planes = 0;  ///< besides R, G, B, A
};

/// Bytes that the files of a job take in each folder, at the compression measured for noisy images.
///
/// `is_shard` an EXR holds a shard, not an image
/// Precision  test JobDiskSpace.TheEstimateIsNearTheFiles
std::map<std::filesystem::path, double> estimate_disk_space(const Outputs& outputs, bool is_shard,
                                                            const ImageSize& size);

/// Refuses a job whose files do not fit on the disk. Files that they replace stay until then, and so free no space.
///
/// `limit`    bytes per folder, in place of the free space; 0: the free space
/// Errors     base::Error(kCannotCreate) with both figures
void require_disk_space(const Outputs& outputs, bool is_shard, const ImageSize& size, std::uint64_t limit);

}  // namespace orrery::job
