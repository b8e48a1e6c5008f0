// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "denoise/planes.h"

namespace orrery::denoise {

/// Number of guides: albedo, normal, inverse depth.
inline constexpr std::size_t kGuides = 7;

/// Whether a pixel at an offset is a neighbour: windows are round.
constexpr bool is_neighbor(int radius, int dx, int dy) { return dx * dx + dy * dy <= radius * radius + 2; }
/// Number of neighbours of a pixel, with itself.
constexpr std::size_t neighbors(int radius) {
  std::size_t count = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) count += is_neighbor(radius, dx, dy) ? 1 : 0;
  return count;
}

/// Two independent estimates of a channel by which patches are compared. Without independent estimates, `a` and `b` are
/// the same plane.
struct ComparedChannel {
  const PaddedPlane* a = nullptr;
  const PaddedPlane* b = nullptr;
};

/// The data from which the weights of a tile are computed.
struct WeightSource {
  std::vector<ComparedChannel> compared;
  const PaddedPlane* variance = nullptr;  ///< variance of the mean of `a` and `b`, summed over the channels
  int radius = kWindowRadius;             ///< radius of the window of neighbours, at most kWindowRadius, px
  float tolerance = 1;                 ///< squared difference of patches, in variances, at which the weight becomes 0
  const PaddedPlane* valid = nullptr;  ///< 1, or 0 for pixels to ignore; 0 outside the image
  /// kGuides planes, scaled so that the weight becomes 0 at a difference of 1; empty: no guides.
  std::vector<const PaddedPlane*> guides;
  const PaddedPlane* guide_variance = nullptr;  ///< sum of the variances of all guides
  bool has_regression = false;                  ///< regression on the guides; otherwise a weighted mean
  /// The image to be filtered. Where regression would make it negative, it is blended with the weighted mean.
  std::array<const PaddedPlane*, 3> target = {};
};

/// A value for each pixel of a tile, in rows of kTileWidth.
struct alignas(kMaxLanes * sizeof(float)) TilePixels
    : std::array<float, static_cast<std::size_t>(kTileWidth) * kTileHeight> {};

/// The weight of each neighbour of each pixel of a tile, by offset. A pixel's weights add up to 1, or are all 0 if it
/// has no valid neighbour.
using TileWeights = std::vector<TilePixels>;

/// Buffers of a thread.
struct TileScratch {
  std::vector<float> distances, columns;
};

/// Computes weights by non-local means: the weight of a neighbour is the similarity of the patches around both pixels.
/// With `has_regression`, the weights are those of a linear regression on the guides over the neighbours.
///
/// `x`, `y`   upper left pixel of the tile, multiples of its size
/// `out`      resized to the number of neighbours
/// Precision  the same bits with every instruction set
/// Reference  buades2005, rousselle2012, bitterli2016
void compute_weights(const WeightSource& source, int x, int y, TileScratch& scratch, TileWeights& out);

/// Applies the weights of a tile to a plane.
///
/// `radius`   WeightSource::radius of the weights
void apply_weights(const TileWeights& weights, int radius, const PaddedPlane& plane, int x, int y, TilePixels& out);

/// Buffers of a thread that filters tiles.
struct Worker {
  TileScratch scratch;
  TileWeights weights;
  TilePixels pixels;
};

/// The tiles of an image.
class Tiles {
 public:
  explicit Tiles(Frame frame) : frame_(frame) {}

  /// Calls `f(worker, x, y)` with the upper left pixel of each tile, on all threads.
  template <class F>
  void each(F f) {
    const int columns = (frame_.width + kTileWidth - 1) / kTileWidth;
    const int rows = (frame_.height + kTileHeight - 1) / kTileHeight;
    tbb::parallel_for(0, columns * rows, [&](int tile) {
      frame_.check();
      f(workers_.local(), tile % columns * kTileWidth, tile / columns * kTileHeight);
    });
  }

  /// Calls `f(index in the tile, x, y)` for the pixels of a tile that are within the image.
  template <class F>
  void each_pixel(int x0, int y0, F f) const {
    for (int y = y0; y < std::min(y0 + kTileHeight, frame_.height); ++y)
      for (int x = x0; x < std::min(x0 + kTileWidth, frame_.width); ++x)
        f(static_cast<std::size_t>((y - y0) * kTileWidth + x - x0), x, y);
  }

 private:
  Frame frame_;
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace orrery::denoise
