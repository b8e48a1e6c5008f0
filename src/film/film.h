// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/pixel_sum.h"

namespace orrery::film {

struct Picture;

/// Exact sample sums of all pixels, independent of the order of addition.
class Film {
 public:
  Film(int width_px, int height_px);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  std::size_t pixel_count() const noexcept { return sums_.size(); }

  /// Pointer to the sum of a pixel. Rows are contiguous and width() apart.
  kernel::PixelSum* at(int x, int y) noexcept;

  /// The sums of all pixels, row by row from the top.
  const std::vector<kernel::PixelSum>& sums() const noexcept { return sums_; }
  std::vector<kernel::PixelSum>& sums() noexcept { return sums_; }

  /// Adds the samples of another film of the same size.
  void add(const Film& other);

  /// The mean of every pixel's samples as planes R, G, B, and A = 1. Pixels without samples are black.
  ///
  /// `second`   more samples, of a film of the same size; null: none
  Picture picture(const Film* second = nullptr) const;

 private:
  int width_, height_;
  std::vector<kernel::PixelSum> sums_;
};

}  // namespace orrery::film
