// SPDX-License-Identifier: Apache-2.0
#include "render/share.h"

#include <cstddef>

namespace orrery::render {

std::vector<bool> pixels_of(const Share& share, int width_px, int height_px) {
  std::vector<bool> out(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), true);
  if (share.count == 1) return out;
  const int across = (width_px + kShareSide - 1) / kShareSide;
  std::size_t at = 0;
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      out[at++] = (y / kShareSide * across + x / kShareSide) % share.count == share.index;
  return out;
}

}  // namespace orrery::render
