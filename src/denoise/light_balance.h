// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "denoise/planes.h"

namespace orrery::denoise {

/// Distance between the centres of neighbouring parts, px.
inline constexpr int kPartSpacing = 64;

/// Light that was removed from a pixel.
struct RemovedLight {
  std::size_t pixel;  ///< index
  double light;       ///< not negative
};

/// Factors that restore the light of each part of a filtered plane to its value before filtering. The filter does not
/// preserve energy: what a pixel receives from others can differ from what it contributes to them.
///
/// Parts are overlapping tents, 2 * kPartSpacing wide, that add up to 1 in each pixel, so that factors interpolated
/// between parts preserve the sum over the image. A part that lost light is multiplied by a factor of up to 1.05. In a
/// part that gained light, the pixels that are brighter than before give back the same fraction of their gain.
///
/// The light of outliers, which was removed from the image before filtering, counts as lost. In a part with N outliers,
/// the limit of the factor is larger by the square root of N, which reflects the statistical certainty of their number.
/// Light beyond the limits is spread over the whole image; if that would change the image too much, the excess is
/// returned to the outliers.
class LightBalance {
 public:
  /// Computes the factors of a plane.
  ///
  /// `before`, `after`   plane before and after filtering
  /// `valid`             1, or 0 for pixels to ignore, whose values may be anything
  /// `removed`           light that was removed from the plane before `before` was taken
  LightBalance(const PaddedPlane& before, const Values& after, const PaddedPlane& valid, Frame frame,
               const std::vector<RemovedLight>& removed = {});

  /// The factor for a valid pixel; not negative.
  ///
  /// `before`, `after`   the pixel's values
  double at(int x, int y, float before, float after) const;

 private:
  struct Part {
    double lift = 0;   ///< fraction of all light to add
    double share = 0;  ///< fraction of the gains to give back
  };

  int columns_;
  double lift_ = 0;  ///< lift of the whole image
  std::vector<Part> parts_;
};

}  // namespace orrery::denoise
