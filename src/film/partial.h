// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "film/film.h"
#include "film/layer_pixel.h"

namespace orrery::film {

/// What rendering has done so far, over all runs of the program.
struct RenderWork {
  std::uint64_t paths = 0, rays = 0;
  std::uint64_t bad_samples = 0;  ///< not finite; counted and left out of their pixel's mean
  double seconds = 0;             ///< of rendering; building and files left out

  RenderWork& operator+=(const RenderWork& other);
};

/// A picture whose samples are not all there: what a stopped render goes on from, and what parts of a picture are
/// joined by. All sums are whole numbers, so that it does not matter where a picture was cut, nor in which order it is
/// joined.
struct Partial {
  Partial() : Partial(0, 0) {}
  Partial(int width_px, int height_px) : film(width_px, height_px), counts(film.pixel_count()) {}

  std::size_t pixel_count() const { return film.pixel_count(); }
  bool has_halves() const { return second.pixel_count() > 0; }

  Film film;                          ///< sums of samples; of the first half's, where there are two
  Film second{0, 0};                  ///< of the other half's; without pixels unless the render is one in rounds
  std::vector<std::uint32_t> counts;  ///< samples of each pixel, row by row; of each half
  /// What the running pass brings each pixel to, where that is not the same for all; else empty.
  std::vector<std::uint32_t> goals;
  std::vector<LayerPixel> layers;  ///< empty without layers
  RenderWork work;
};

}  // namespace orrery::film
