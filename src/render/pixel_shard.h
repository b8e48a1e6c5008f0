// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::render {

/// One of several parts of a picture, made of squares that are dealt out like cards: neighbouring ones, which cost
/// about the same, go to different parts.
struct PixelShard {
  int index = 0;  ///< from 0
  int count = 1;  ///< of all parts
};

/// Sides of the squares, px.
inline constexpr int kShardSide = 16;

/// Which pixels belong to a shard, row by row. The shares of one count have every pixel once among them.
std::vector<bool> pixels_of(const PixelShard& shard, int width_px, int height_px);

}  // namespace orrery::render
