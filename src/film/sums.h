// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/zero_pages.h"
#include "film/layer_sums.h"
#include "film/layers.h"
#include "kernel/pixel_sum.h"

namespace orrery::film {

/// Work done so far, summed over all runs of the program.
struct RenderWork {
  std::uint64_t paths = 0, rays = 0;
  std::uint64_t bad_samples = 0;  ///< samples with an invalid value, excluded from the pixel means
  double seconds = 0;             ///< rendering time, without BVH construction and file I/O

  RenderWork& operator+=(const RenderWork& other);
};

/// The sums of all samples so far: the state of a render, and the content of a checkpoint or shard. They have the
/// arrays that a render needs, of one element for each pixel, row by row; others are empty.
///
/// All sums are integers, so that the result does not depend on how a render is split or in which order shards are
/// merged.
struct Sums {
  /// No samples.
  Sums(int width_px, int height_px, const LayerRequest& request = {}, bool is_adaptive = false);

  std::size_t pixel_count() const { return counts.size(); }
  /// The sums are those of adaptive sampling.
  bool is_adaptive() const { return !largest.empty(); }
  /// The samples are divided into two halves: for adaptive sampling, and for the denoiser.
  bool has_halves() const { return !light[1].empty(); }

  /// Returns whether this has the arrays of another one.
  bool has_arrays_of(const Sums& other) const;
  /// Size of all arrays.
  std::size_t bytes() const;

  /// Adds the samples of another shard with the same arrays.
  ///
  /// Domain     without adaptive sampling
  void add(const Sums& other);

  /// Returns whether all sphere ids in the layers are below `count`. A damaged file may contain others.
  bool has_known_spheres(std::size_t count) const;

  /// The sum of a pixel's samples.
  kernel::PixelSum sum(std::size_t pixel) const {
    kernel::PixelSum out = light[0][pixel];
    if (has_halves()) out += light[1][pixel];
    return out;
  }
  /// Number of a pixel's paths, including those with bad samples.
  std::uint64_t paths(std::size_t pixel) const { return std::uint64_t{counts[pixel]} * (is_adaptive() ? 2 : 1); }

  /// Writes the mean of a pixel's samples, R, G and B; 0 without samples. These are the bits of the finished image.
  void mean(std::size_t pixel, float* rgb) const;

  /// The fraction of a pixel that is not background; 0 without samples.
  ///
  /// Domain     with LayerRequest::coverage
  float coverage(std::size_t pixel) const;

  int width, height;  ///< px
  /// Samples of both halves; without halves, all are in the first.
  std::array<base::ZeroVector<kernel::PixelSum>, 2> light;
  std::array<base::ZeroVector<kernel::GuideSum>, 2> guides;  ///< of both halves; only with LayerRequest::guides()
  base::ZeroVector<float> largest;         ///< largest sample, sum of the channels; only for adaptive sampling
  base::ZeroVector<std::uint32_t> counts;  ///< samples; in adaptive sampling, samples of each half
  /// Target sample count in the current pass; empty if it is the same for all.
  base::ZeroVector<std::uint32_t> goals;
  LayerSums layers;
  RenderWork work;
};

/// The mean of fixed-point values from their sum and number; 0 without values.
inline double mean(kernel::Int128 sum, std::int64_t count) {
  return count > 0 ? kernel::from_fixed_point(sum) / static_cast<double>(count) : 0.0;
}

/// Serializes sums to 32-bit words: a header, then a plane over all pixels for each word of each per-pixel number, or a
/// single value if it is the same for all pixels.
std::vector<std::uint32_t> to_words(const Sums& sums);

/// Deserializes the result of to_words(). Words after the end are ignored as padding.
///
/// Domain     any words; sphere indices in layers are not checked against a scene
/// Errors     base::Error(kBadData) if the words are not sums of this size
Sums from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px);

/// Pixels that have received samples.
///
/// Domain     `pixels` is relative to x, y and inside the rectangle
struct RenderedPixels {
  int x = 0, y = 0, width = 0, height = 0;  ///< px, a rectangle around the pixels
  std::span<const kernel::PixelPlace> pixels = {};
};

}  // namespace orrery::film
