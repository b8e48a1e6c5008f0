// SPDX-License-Identifier: Apache-2.0
#include "render/settings.h"

#include <cstddef>

#include "math/pixels.h"

namespace orrery::render {

std::vector<bool> pixels_of(const PixelShard& shard, int width_px, int height_px) {
  std::vector<bool> out(math::pixel_count(width_px, height_px), true);
  if (shard.count == 1) return out;
  const int across = (width_px + kShardSide - 1) / kShardSide;
  std::size_t at = 0;
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      out[at++] = (y / kShardSide * across + x / kShardSide) % shard.count == shard.index;
  return out;
}

}  // namespace orrery::render
