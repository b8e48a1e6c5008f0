// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "denoise/plane_values.h"

namespace orrery::denoise {

/// Distance between the centres of neighbouring parts, px.
inline constexpr int kPartSpacing = 64;

/// Factors that restore the light of each part of a filtered plane to its value before filtering. The filter does not
/// preserve it: what a pixel receives from others can differ from what it contributes to them.
///
/// Parts are overlapping tents, 2 * kPartSpacing wide, that add up to 1 in each pixel, so that factors interpolated
/// between parts preserve the sum over the image. A part that lost light is multiplied by a factor of up to 1.05. In a
/// part that gained light, the pixels that are brighter than before give back the same fraction of their gain.
class LightBalance {
 public:
  /// Computes the factors of a plane.
  ///
  /// `before`, `after`   plane before and after filtering
  /// `valid`             1, or 0 for pixels to ignore, whose values may be anything
  LightBalance(const PaddedPlane& before, const Values& after, const PaddedPlane& valid, Frame frame);

  /// The factor for a valid pixel; not negative.
  ///
  /// `before`, `after`   its values
  double at(int x, int y, float before, float after) const;

 private:
  struct Part {
    double lift = 0;   ///< fraction of all light to add
    double share = 0;  ///< fraction of the gains to give back
  };

  int columns_;
  std::vector<Part> parts_;
};

}  // namespace orrery::denoise
