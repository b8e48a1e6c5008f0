// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace orrery::render {

/// What two independent halves of each pixel's samples tell, row by row.
struct PixelStatistics {
  PixelStatistics(int width_px, int height_px);

  int width, height;                   ///< px
  std::vector<std::uint32_t> samples;  ///< of each half, above 0
  std::vector<float> light;            ///< mean of the three channels, both halves together, at least 0
  std::vector<float> variance;         ///< of the pixel's estimate of its light, mean of the three channels
  /// 1: no path met anything that could send light, so that black is what the pixel is; empty: not known of any.
  std::vector<std::uint8_t> known_black;

  bool is_known_black(std::size_t i) const { return !known_black.empty() && known_black[i] != 0; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Pixels in nine interleaved classes, (x mod 3, y mod 3): no two of a class are within a square of five by five.
inline constexpr int kClasses = 9;
/// In place of a class: all pixels are used.
inline constexpr int kNoClass = -1;

inline int class_of(int x, int y) { return x % 3 + y % 3 * 3; }

/// A rectangle of pixels that is processed in one go.
struct PixelBlock {
  int x, y, width, height;  ///< px
};

/// The blocks of a picture, in a fixed order.
std::vector<PixelBlock> blocks_of(int width_px, int height_px);

/// Pixels within `reach` of each other along an axis and within the picture: how many, and how many of them have the
/// remainder `remainder` by three; below 0: none.
int count_within(int at, int reach, int size);
int count_within(int at, int reach, int size, int remainder);

/// An estimate of the light of every pixel that borrows from its neighbours as far as its own samples are uncertain.
///
/// A pixel's error is relative to its light, and its own estimate of that is useless where light is rare: no hit says
/// no light, and a single hit says that the error is half the light, however rare such hits are. So the mean of the
/// whole picture is refined by those of smaller and smaller windows, each as far as its own variance allows (its
/// light is expected to vary by as much as it is), and at last by the pixel's own value, as far as the pixels of five
/// by five differ by more than their variance (Wiener's filter).
///
/// Reference  lee1980
class LightGuide {
 public:
  /// Leaves out the pixels of `excluded_class`, so that the result does not depend on them.
  ///
  /// Domain     the statistics outlive this
  LightGuide(const PixelStatistics& statistics, int excluded_class);

  /// The guide of a block's pixels, row by row. The values of pixels of the excluded class mean nothing.
  std::vector<float> of(const PixelBlock& block) const;

 private:
  const PixelStatistics& statistics_;
  int excluded_class_;
  float mean_ = 0;
};

}  // namespace orrery::render
