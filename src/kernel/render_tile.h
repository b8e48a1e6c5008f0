// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/camera.h"
#include "kernel/forward.h"
#include "kernel/pixel_sum.h"
#include "kernel/precision.h"

namespace orrery::kernel {

/// A rectangle of pixels, or some of its pixels, and the range of samples to render.
struct Tile {
  int x = 0, y = 0;  ///< px, upper left corner, within the rendered window
  int width = 0, height = 0;
  std::uint32_t sample_begin = 0, sample_end = 0;
  /// Also renders the same samples of the second half, from Sampler::kSecondHalf on. Only without records.
  bool has_both_halves = false;
  PixelSum* sums = nullptr;  ///< sum of the upper left pixel
  /// The pixels' largest samples (sum of the channels), laid out like the sums; null: not needed.
  float* largest = nullptr;
  std::int64_t row_stride = 0;         ///< distance from a pixel's sum to that of the pixel below, elements
  std::int64_t half_stride = 0;        ///< from a pixel's sum or guides to those of its second half, if it has both
  const PixelPlace* chosen = nullptr;  ///< the pixels to render, relative to the upper left one; null: all
  int chosen_count = 0;
  /// One record per path: the samples of a pixel, then the next pixel of the row. Null: not needed.
  PathRecord* records = nullptr;
  /// Sums of the pixels' coverage by what is not background, in units of kGuideUnit, laid out like the sums; null: not
  /// needed.
  std::int64_t* covered = nullptr;
  GuideSum* guides = nullptr;     ///< guides of the upper left pixel, laid out like the sums; null: not needed
  LightEvents* events = nullptr;  ///< receives the paths' light events; null: not needed
  bool record_light = true;       ///< false: the records' light and light events are not needed
  bool record_hits = true;  ///< false: only the records' light is needed, and only that of paths with light events

  /// Whether there is anything besides the sums and the largest samples.
  bool is_recorded() const noexcept { return records != nullptr || guides != nullptr || events != nullptr; }
  bool has_events() const noexcept { return events != nullptr && record_light; }

  int pixel_count() const noexcept { return chosen != nullptr ? chosen_count : width * height; }
  /// The i-th pixel to render, relative to the upper left one.
  PixelPlace pixel(int i) const noexcept { return chosen != nullptr ? chosen[i] : PixelPlace{i % width, i / width}; }
  /// The index of a pixel of the window among the largest samples, and among the sums of the first half.
  std::int64_t index(PixelPlace at) const noexcept { return (at.y - y) * row_stride + (at.x - x); }
  /// The index of the sum that a sample of a pixel belongs to.
  std::int64_t index(PixelPlace at, std::uint64_t sample) const noexcept {
    return index(at) + (has_both_halves && sample >= Sampler::kSecondHalf ? half_stride : 0);
  }
  /// The index of the record of a path.
  std::int64_t record_index(PixelPlace at, std::uint64_t sample) const noexcept {
    const auto count = static_cast<std::int64_t>(sample_end - sample_begin);
    return (std::int64_t{at.y - y} * width + (at.x - x)) * count + static_cast<std::int64_t>(sample - sample_begin);
  }
  std::uint64_t path_count() const noexcept {
    return static_cast<std::uint64_t>(pixel_count()) * (sample_end - sample_begin) * (has_both_halves ? 2 : 1);
  }
};

struct TileCounts {
  std::uint64_t rays = 0;
  std::uint64_t bad_samples = 0;  ///< not finite or above kLargestSample; excluded from the sums
  std::int64_t target = 0;        ///< instruction set that the loop was compiled for, HWY_AVX2 etc.
};

/// Renders a tile: adds its samples to the tile's sums and fills its records, events and guides.
///
/// Domain     the tracer intersects the view's spheres in the loop's precision; tiles with events have records
using RenderTile = TileCounts (*)(const SceneView& scene, const Tracer& tracer, const Tile& tile, PathStream& stream);

/// Returns the path loop for the best enabled instruction set: the plain or the full one.
///
/// `records`  tiles may have records, events and guides, which only a full loop fills
/// Domain     the scene has these features
/// Result     bit-identical images for any number of lanes, plain or full, with or without records, and on every
///            instruction set with fused multiply-add
RenderTile render_tile_function(const Features& features, Precision precision, bool records);

}  // namespace orrery::kernel
