// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "denoise/padded_plane.h"

namespace orrery::denoise {

/// A plane's values in rows from the top.
using Values = std::vector<float>;

/// Maximum usable value: larger values would overflow when squared.
inline constexpr float kLargest = 0x1p40F;

inline bool is_usable(float v) { return std::abs(v) <= kLargest; }
/// Returns 0 for values that are not finite or too large.
inline float usable(float v) { return is_usable(v) ? v : 0; }

/// Size of an image, and the indices of its pixels row by row.
struct Frame {
  int width, height;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  /// Index of the pixel nearest to (x, y), which may be outside the image.
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(std::clamp(x, 0, width - 1));
  }
  int x(std::size_t pixel) const { return static_cast<int>(pixel % static_cast<std::size_t>(width)); }
  int y(std::size_t pixel) const { return static_cast<int>(pixel / static_cast<std::size_t>(width)); }
  /// Returns the plane of the values f(x, y).
  template <class F>
  Values each(F f) const {
    Values out(pixels());
    tbb::parallel_for(0, height, [&](int y) {
      for (int x = 0; x < width; ++x) out[at(x, y)] = f(x, y);
    });
    return out;
  }
  /// Returns the plane of the values f(index).
  template <class F>
  Values each_index(F f) const {
    Values out(pixels());
    tbb::parallel_for(0, height, [&](int y) {
      for (std::size_t i = at(0, y); i < at(0, y) + static_cast<std::size_t>(width); ++i) out[i] = f(i);
    });
    return out;
  }
};

/// Means over square windows. Edge pixels are repeated beyond the image.
Values window_means(const Values& in, Frame frame, int radius_px);

/// Minimum over each pixel and the four pixels at a distance to the left, right, above and below.
Values least_around(const Values& in, Frame frame, int distance_px);

/// The same plane of two independent halves of the samples.
struct HalfPair {
  const Values* a;
  const Values* b;
  float scale = 1;  ///< scale of the values
};

/// Variance of the mean of two halves, averaged over square windows; sum over the planes.
///
/// `limits`   largest standard deviation of each pixel, if any
Values variance_of(const std::vector<HalfPair>& planes, Frame frame, int radius_px, const Values* limits = nullptr);

/// Multiplies the value of a pixel and its copies in the border.
void scale_pixel(PaddedPlane& plane, Frame frame, std::size_t pixel, float factor);

/// Copies values into a padded plane, whose border repeats the edge pixels. Values that are not finite or too large
/// become 0.
PaddedPlane padded(const Values& values, Frame frame, float scale = 1);

}  // namespace orrery::denoise
