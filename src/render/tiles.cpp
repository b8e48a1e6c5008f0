// SPDX-License-Identifier: Apache-2.0
#include "render/tiles.h"

#include <algorithm>
#include <cmath>

namespace orrery::render {
namespace {

/// Sides of a tile: neighbouring pixels share what they look at, so square and up to here.
constexpr int kLargestTile = 32;
constexpr int kSmallestTile = 4;

/// Paths in a tile: some milliseconds of work.
constexpr double kPathsPerTile = 65536;

}  // namespace

std::vector<kernel::Tile> make_tiles(int width, int height, int samples, film::Film& film) {
  const auto wanted = static_cast<int>(std::sqrt(kPathsPerTile / samples));
  const int side = std::clamp(wanted, kSmallestTile, kLargestTile);
  std::vector<kernel::Tile> tiles;
  for (int y = 0; y < height; y += side) {
    for (int x = 0; x < width; x += side) {
      kernel::Tile tile;
      tile.x = x;
      tile.y = y;
      tile.width = std::min(side, width - x);
      tile.height = std::min(side, height - y);
      tile.sample_end = static_cast<std::uint32_t>(samples);
      tile.sums = film.at(x, y);
      tile.row_stride = width;
      tiles.push_back(tile);
    }
  }
  return tiles;
}

}  // namespace orrery::render
