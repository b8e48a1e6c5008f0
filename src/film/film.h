// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "film/picture.h"
#include "kernel/pixel_sum.h"

namespace orrery::film {

/// The sums of all samples of a picture, exact, in whatever order they came.
class Film {
 public:
  Film(int width_px, int height_px);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  std::size_t pixel_count() const noexcept { return sums_.size(); }

  /// The sum of a pixel; the one to the right is next, the one below is width() further on.
  kernel::PixelSum* at(int x, int y) noexcept;

  /// All of them, row by row.
  const std::vector<kernel::PixelSum>& sums() const noexcept { return sums_; }
  std::vector<kernel::PixelSum>& sums() noexcept { return sums_; }

  /// Adds the samples of another film of the same size.
  void add(const Film& other);

  /// The mean of every pixel's samples as planes R, G, B, and A = 1; 0 where there is no sample.
  film::Picture picture() const;

 private:
  int width_, height_;
  std::vector<kernel::PixelSum> sums_;
};

}  // namespace orrery::film
