// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/pixel_statistics.h"

namespace orrery::render {

/// A rectangle of pixels that is processed at once.
struct PixelBlock {
  int x, y, width, height;  ///< px
};

/// The blocks of an image, in a fixed order.
std::vector<PixelBlock> blocks_of(int width_px, int height_px);

/// The number of pixels within `reach` of `at` along an axis of the image. The second overload counts only pixels whose
/// coordinate modulo three is `remainder`; a negative `remainder` counts none.
int window_size(int at, int reach, int size);
int window_size(int at, int reach, int size, int remainder);

/// An estimate of every pixel's radiance that relies on its neighbours to the extent that its own samples are
/// uncertain.
///
/// Errors are relative to the pixel's radiance, but the pixel's own estimate of it fails if light is rare: without a
/// hit it is zero, and with a single hit the relative error is one half, however rare such hits are. Therefore, the
/// mean of the whole image is refined by the means of ever smaller windows, each weighted by its variance (the expected
/// variation of the radiance is the radiance itself), and finally by the pixel's own value, to the extent that the
/// pixels of a 5 x 5 window differ by more than their variance (Wiener filter).
///
/// Reference  lee1980
class LightGuide {
 public:
  /// Ignores the pixels of `excluded_class`, which therefore do not affect the result.
  ///
  /// Domain     the statistics outlive this
  LightGuide(const PixelStatistics& statistics, int excluded_class);

  /// The guide of a block's pixels in row-major order; undefined for pixels of the excluded class.
  std::vector<float> of(const PixelBlock& block) const;

 private:
  const PixelStatistics& statistics_;
  int excluded_class_;
  float mean_ = 0;
};

}  // namespace orrery::render
