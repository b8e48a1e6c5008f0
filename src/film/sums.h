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

/// What a path that sees nothing but a plain background adds to its pixel. Sums are stored less this for each of their
/// paths, so that pixels without objects remain zero and take no memory. Zero: sums are stored as they are.
struct EmptyPath {
  kernel::PixelSum light;
  kernel::GuideSum guides;
  float largest = 0;             ///< see Sums::largest
  std::uint32_t first_half = 0;  ///< samples in the first half, without adaptive sampling

  bool is_known() const { return light.weight > 0; }
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
  /// Domain     without adaptive sampling and `empty`
  void add(const Sums& other);

  /// Returns whether all sphere ids in the layers are below `count`. A damaged file may contain others.
  bool has_known_spheres(std::size_t count) const;

  /// The sums of a pixel's samples in a half.
  kernel::PixelSum light_of(std::size_t half, std::size_t pixel) const;
  kernel::GuideSum guides_of(std::size_t half, std::size_t pixel) const;
  /// The sum of a pixel's samples.
  kernel::PixelSum sum(std::size_t pixel) const;
  /// Number of a pixel's paths, including those with bad samples.
  std::uint64_t paths(std::size_t pixel) const { return std::uint64_t{counts[pixel]} * (is_adaptive() ? 2 : 1); }

  /// Writes the mean of a pixel's samples, R, G and B; 0 without samples. These are the bits of the finished image.
  void mean(std::size_t pixel, float* rgb) const;

  /// The fraction of a pixel that is not background; 0 without samples.
  ///
  /// Domain     with LayerRequest::coverage
  float coverage(std::size_t pixel) const;

  /// Adds sums to those of a pixel in a half.
  ///
  /// `paths`    number of their paths
  void add_light(std::size_t half, std::size_t pixel, kernel::PixelSum sum, std::uint32_t paths);
  void add_guides(std::size_t half, std::size_t pixel, kernel::GuideSum sum, std::uint32_t paths);
  /// Adds paths of a pixel without objects as far as `empty` does not account for them.
  void add_empty(std::size_t half, std::size_t pixel, const EmptyPath& path, std::uint32_t paths);

  /// Clears `empty` and stores the sums as they are.
  void add_empty_to_sums();

  int width, height;  ///< px
  EmptyPath empty;    ///< already subtracted from `light` and `guides`
  /// Samples of both halves, less `empty` for each; without halves, all are in the first.
  std::array<base::ZeroVector<kernel::PixelSum>, 2> light;
  /// Of both halves, less `empty` for each sample; only with LayerRequest::guides().
  std::array<base::ZeroVector<kernel::GuideSum>, 2> guides;
  base::ZeroVector<float> largest;         ///< largest sample, sum of the channels; only for adaptive sampling
  base::ZeroVector<std::uint32_t> counts;  ///< samples; in adaptive sampling, samples of each half
  /// Target sample count in the current pass; empty if it is the same for all.
  base::ZeroVector<std::uint32_t> goals;
  LayerSums layers;
  RenderWork work;

 private:
  /// Number of a pixel's paths in a half.
  std::uint32_t paths_of(std::size_t half, std::size_t pixel) const;
};

/// The mean of fixed-point values from their sum and number; 0 without values.
inline double mean(kernel::Int128 sum, std::int64_t count) {
  return count > 0 ? kernel::from_fixed_point(sum) / static_cast<double>(count) : 0.0;
}

/// Serializes sums, without `empty`, to 32-bit words: a header, then a plane over all pixels for each word of each
/// per-pixel number, or a single value if it is the same for all pixels.
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
