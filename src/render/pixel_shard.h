// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::render {

/// A shard of an image's pixels. Squares are assigned round-robin, so that neighbouring ones, which cost about the
/// same, go to different shards.
struct PixelShard {
  int index = 0;  ///< from 0
  int count = 1;  ///< number of shards
};

/// Side of the squares, px.
inline constexpr int kShardSide = 16;

/// Mask of the pixels that belong to a shard, in row-major order. The shards of one count partition the image.
std::vector<bool> pixels_of(const PixelShard& shard, int width_px, int height_px);

}  // namespace orrery::render
