// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include "denoise/tile_filter.h"

namespace orrery::denoise {

/// Buffers of a thread that filters tiles.
struct Worker {
  TileScratch scratch;
  TileWeights weights;
  TilePixels pixels;
};

/// The tiles of an image.
class Tiles {
 public:
  Tiles(int width, int height) : width_(width), height_(height) {}

  /// Calls `f(worker, x, y)` with the upper left pixel of each tile, on all threads.
  template <class F>
  void each(F f) {
    const int columns = (width_ + kTileWidth - 1) / kTileWidth, rows = (height_ + kTileHeight - 1) / kTileHeight;
    tbb::parallel_for(0, columns * rows, [&](int tile) {
      f(workers_.local(), tile % columns * kTileWidth, tile / columns * kTileHeight);
    });
  }

  /// Calls `f(index in the tile, x, y)` for the pixels of a tile that are within the image.
  template <class F>
  void each_pixel(int x0, int y0, F f) const {
    for (int y = y0; y < std::min(y0 + kTileHeight, height_); ++y)
      for (int x = x0; x < std::min(x0 + kTileWidth, width_); ++x)
        f(static_cast<std::size_t>((y - y0) * kTileWidth + x - x0), x, y);
  }

 private:
  int width_, height_;
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace orrery::denoise
