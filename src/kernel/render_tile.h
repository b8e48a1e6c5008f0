// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/path_record.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::kernel {

/// The largest width and height of a picture: a pixel's name is y << 16 | x.
inline constexpr int kLargestSide = 65536;

/// A pixel by its name, y << 16 | x within the frame, as its place in the rendered window.
struct PixelPlace {
  int x, y;
};
inline PixelPlace place_of(std::uint64_t name, const SceneView& scene) noexcept {
  return {static_cast<int>((name - scene.window_x) & 0xffff),
          static_cast<int>(((name >> 16) - scene.window_y) & 0xffff)};
}

/// A rectangle of pixels, or some of them, and the samples that each shall get.
struct Tile {
  int x = 0, y = 0;  ///< px, upper left corner, within the rendered window
  int width = 0, height = 0;
  std::uint32_t sample_begin = 0, sample_end = 0;
  PixelSum* sums = nullptr;            ///< of the upper left pixel
  std::int64_t row_stride = 0;         ///< from a pixel's sum to the one below
  const PixelPlace* chosen = nullptr;  ///< the only pixels that get samples, counted from the upper left one; null: all
  int chosen_count = 0;
  /// A record for every path: the samples of a pixel, then the pixel to the right. Null: nobody asks for them.
  PathRecord* records = nullptr;
  bool record_light = true;   ///< false: nobody reads light and group of the records
  bool record_guides = true;  ///< the same of the guides

  int pixel_count() const noexcept { return chosen != nullptr ? chosen_count : width * height; }
  /// The i-th pixel that gets samples, counted from the upper left one.
  PixelPlace pixel(int i) const noexcept { return chosen != nullptr ? chosen[i] : PixelPlace{i % width, i / width}; }
  std::uint64_t path_count() const noexcept {
    return static_cast<std::uint64_t>(pixel_count()) * (sample_end - sample_begin);
  }
};

struct TileCounts {
  std::uint64_t rays = 0;
  std::uint64_t bad_samples = 0;  ///< not finite or above kLargestSample; left out of the sums
  std::int64_t target = 0;        ///< instruction set that the loop was compiled for, HWY_AVX2 etc.
};

/// Renders a tile into its sums.
///
/// Domain     the tracer finds hits in the view's spheres, in the precision that the function was chosen for
using RenderTile = TileCounts (*)(const SceneView& scene, const Tracer& tracer, const Tile& tile, PathStream& stream);
using RenderTileFast = TileCounts (*)(const SceneView& scene, const Tracer& tracer, const Tile& tile,
                                      PathStreamFast& stream);

/// How many lanes the kernel's text is compiled for.
enum class Lanes : std::uint8_t {
  kOne,  ///< the oracle that the others are held against
  kAll,  ///< as many as the processor has
};

/// The path loop for the best instruction set that is enabled on this processor, without what no scene with these
/// features needs.
///
/// Domain     the scene that is rendered has these features
/// Result     bit-identical pictures for both lane counts, with records or without, and on every instruction set with
///            fused multiply-add
RenderTile render_tile_function(const Features& features, Precision precision, Lanes lanes = Lanes::kAll);
RenderTileFast render_tile_fast_function(const Features& features);

/// The same loop, which also fills the tile's records.
///
/// Domain     tiles have records
RenderTile record_tile_function(const Features& features, Precision precision);
RenderTileFast record_tile_fast_function(const Features& features);

}  // namespace orrery::kernel
