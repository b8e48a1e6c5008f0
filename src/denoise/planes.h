// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <tbb/parallel_for.h>

#include "base/stop_point.h"
#include "math/pixels.h"

namespace orrery::denoise {

/// Maximum distance of a pixel's neighbours in x and in y, px.
inline constexpr int kWindowRadius = 4;
/// Radius of the patches that are compared, px.
inline constexpr int kPatchRadius = 1;

/// Size of the tiles that are filtered at a time, px. The weights of a tile, one float per pixel and neighbour, stay in
/// the L2 cache.
inline constexpr int kTileWidth = 64, kTileHeight = 16;

/// Maximum number of float lanes of an instruction set: rows of a tile are read and written in whole vectors.
inline constexpr int kMaxLanes = 16;

/// A plane with a border, so that filters need no test for the image's edge.
class PaddedPlane {
 public:
  static constexpr int kBorder = kWindowRadius + kPatchRadius;

  PaddedPlane() = default;
  /// A plane of zeros.
  PaddedPlane(int width_px, int height_px) : stride_(whole(width_px, kTileWidth) + 2 * kBorder + kMaxLanes) {
    const std::ptrdiff_t rows = whole(height_px, kTileHeight) + 2 * kBorder;
    values_ = std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(stride_ * rows));
    // In parallel, since most of the time is spent on page faults.
    tbb::parallel_for(std::ptrdiff_t{0}, rows,
                      [&](std::ptrdiff_t y) { std::fill_n(&values_[y * stride_], stride_, 0.0F); });
  }

  /// Pointer to a pixel; x and y can be up to kBorder outside the tiles that cover the image.
  float* at(int x, int y) { return values_.get() + (y + kBorder) * stride_ + x + kBorder; }
  const float* at(int x, int y) const { return values_.get() + (y + kBorder) * stride_ + x + kBorder; }

 private:
  static std::ptrdiff_t whole(int length, int step) { return (std::ptrdiff_t{length} + step - 1) / step * step; }

  std::ptrdiff_t stride_ = 0;
  std::unique_ptr<float[]> values_;
};

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
  const base::StopPoint* stop = nullptr;  ///< of the loops over rows; null: none

  std::size_t pixels() const { return math::pixel_count(width, height); }
  /// Index of the pixel nearest to (x, y), which may be outside the image.
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(std::clamp(x, 0, width - 1));
  }
  int x(std::size_t pixel) const { return static_cast<int>(pixel % static_cast<std::size_t>(width)); }
  int y(std::size_t pixel) const { return static_cast<int>(pixel / static_cast<std::size_t>(width)); }
  /// Errors     base::Error(kStopped)
  void check() const {
    if (stop != nullptr) stop->check();
  }
  /// Calls f(y) for each row, on all threads.
  template <class F>
  void each_row(F f) const {
    tbb::parallel_for(0, height, [&](int y) {
      check();
      f(y);
    });
  }
  /// Returns the plane of the values f(x, y).
  template <class F>
  Values each(F f) const {
    Values out(pixels());
    each_row([&](int y) {
      for (int x = 0; x < width; ++x) out[at(x, y)] = f(x, y);
    });
    return out;
  }
  /// Returns the plane of the values f(index).
  template <class F>
  Values each_index(F f) const {
    return each([&](int x, int y) { return f(at(x, y)); });
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

/// Adds the squared errors of the mean of two halves.
void add_squared_errors(const HalfPair& plane, Frame frame, Values& to);

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
