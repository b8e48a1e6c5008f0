// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "film/film.h"
#include "film/layer_pixel.h"
#include "kernel/pixel_sum.h"

namespace orrery::film {

/// Work done so far, summed over all runs of the program.
struct RenderWork {
  std::uint64_t paths = 0, rays = 0;
  std::uint64_t bad_samples = 0;  ///< samples with an invalid value, excluded from the pixel means
  double seconds = 0;             ///< rendering time, without BVH construction and file I/O

  RenderWork& operator+=(const RenderWork& other);
};

/// An incomplete render: the content of a checkpoint or shard.
///
/// All sums are integers, so that the result does not depend on how a render is split or in which order shards are
/// merged.
struct Partial {
  Partial() : Partial(0, 0) {}
  Partial(int width_px, int height_px) : film(width_px, height_px), counts(film.pixel_count()) {}

  std::size_t pixel_count() const { return film.pixel_count(); }
  /// The sums are those of adaptive sampling.
  bool is_adaptive() const { return second.pixel_count() > 0; }

  /// Prepares for adaptive sampling.
  void add_second_half();

  /// Adds the samples of another shard of the same size.
  ///
  /// Domain     without adaptive sampling
  void add(const Partial& other);

  /// Returns whether all sphere ids in the layers are below `count`. A damaged file may contain others.
  bool has_known_spheres(std::size_t count) const;

  /// The sum of a pixel's samples, of both halves if there are two.
  kernel::PixelSum sum(std::size_t pixel) const {
    kernel::PixelSum out = film.sums()[pixel];
    if (is_adaptive()) out += second.sums()[pixel];
    return out;
  }

  /// Writes the mean of a pixel's samples, R, G and B; 0 without samples. These are the bits of the finished image.
  void mean(int x, int y, float* rgb) const;

  Film film;          ///< sample sums; those of the first half in adaptive sampling
  Film second{0, 0};  ///< sample sums of the second half in adaptive sampling; else without pixels
  /// Largest sample of each pixel in both halves, sum of the channels; else empty.
  std::vector<float> largest;
  std::vector<std::uint32_t> counts;  ///< samples per pixel, row by row; with two halves, samples per half
  /// Target sample count of each pixel in the current pass; empty if it is the same for all.
  std::vector<std::uint32_t> goals;
  std::vector<LayerPixel> layers;  ///< empty unless LayerRequest::records()
  std::vector<Halves> halves;      ///< empty unless LayerRequest::guides()
  RenderWork work;
};

/// Serializes a partial render to 32-bit words: a header, then a plane over all pixels for each word of each per-pixel
/// number, or a single value if it is the same for all pixels.
std::vector<std::uint32_t> to_words(const Partial& partial);

/// Deserializes the result of to_words(). Words after the end are ignored as padding.
///
/// Domain     any words; sphere indices in layers are not checked against a scene
/// Errors     base::Error(kBadData) if the words are not a partial render of this size
Partial from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px);

/// Pixels that have received samples.
///
/// Domain     `pixels` is relative to x, y and inside the rectangle
struct RenderedPixels {
  int x = 0, y = 0, width = 0, height = 0;  ///< px, a rectangle around the pixels
  std::span<const kernel::PixelPlace> pixels = {};
};

}  // namespace orrery::film
