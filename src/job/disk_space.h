// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>

#include "film/forward.h"

namespace orrery::job {

struct Outputs;

/// Properties of an image that determine the size of its files.
struct ImageSize {
  int width_px = 0, height_px = 0;
  // In addition to R, G, B, A:
  std::size_t half_planes = 0;   ///< half unless the file is float
  std::size_t float_planes = 0;  ///< always float
  std::size_t light_groups = 0;  ///< light groups with separate sums in a shard
};

ImageSize image_size(int width_px, int height_px, const film::LayerRequest& layers);

/// Estimates the bytes that a job writes to each folder, with compression as measured for noisy images.
///
/// `is_shard` EXR outputs are shards, not images
/// Precision  test JobDiskSpace.TheEstimateIsNearTheFiles
std::map<std::filesystem::path, double> estimate_disk_space(const Outputs& outputs, bool is_shard,
                                                            const ImageSize& size);

/// Checks that a job's files fit on the disk. Files that will be replaced do not count as free space, since they exist
/// until then.
///
/// `limit`    bytes per folder that replace the free space; 0: the free space
/// Errors     base::Error(kCannotCreate) with the needed and the allowed size
void require_disk_space(const Outputs& outputs, bool is_shard, const ImageSize& size, std::uint64_t limit);

}  // namespace orrery::job
