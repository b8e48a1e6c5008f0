// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <memory>

namespace orrery::denoise {

/// Maximum distance of a pixel's neighbours in x and in y, px.
inline constexpr int kWindowRadius = 5;
inline constexpr int kOffsets = (2 * kWindowRadius + 1) * (2 * kWindowRadius + 1);
/// Radius of the patches that are compared, px.
inline constexpr int kPatchRadius = 1;

/// Size of the tiles that are filtered at a time, px. The weights of a tile, kOffsets floats per pixel, stay in the L2
/// cache.
inline constexpr int kTileWidth = 64, kTileHeight = 16;

/// Maximum number of float lanes of an instruction set: rows of a tile are read and written in whole vectors.
inline constexpr int kMaxLanes = 16;

/// A plane with a border, so that filters need no test for the image's edge.
class PaddedPlane {
 public:
  static constexpr int kBorder = kWindowRadius + kPatchRadius;

  PaddedPlane() = default;
  /// A plane of zeros.
  PaddedPlane(int width_px, int height_px) : stride_(whole(width_px, kTileWidth) + 2 * kBorder + kMaxLanes) {
    const std::ptrdiff_t rows = whole(height_px, kTileHeight) + 2 * kBorder;
    values_ = std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(stride_ * rows));
    // In parallel, since most of the time is spent on page faults.
    tbb::parallel_for(std::ptrdiff_t{0}, rows,
                      [&](std::ptrdiff_t y) { std::fill_n(&values_[y * stride_], stride_, 0.0F); });
  }

  /// Pointer to a pixel; x and y can be up to kBorder outside the tiles that cover the image.
  float* at(int x, int y) { return values_.get() + (y + kBorder) * stride_ + x + kBorder; }
  const float* at(int x, int y) const { return values_.get() + (y + kBorder) * stride_ + x + kBorder; }

 private:
  static std::ptrdiff_t whole(int length, int step) { return (std::ptrdiff_t{length} + step - 1) / step * step; }

  std::ptrdiff_t stride_ = 0;
  std::unique_ptr<float[]> values_;
};

}  // namespace orrery::denoise
