// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "film/layer_sums.h"
#include "kernel/path_record.h"

namespace orrery::film {

struct LayerRequest;

/// Divides a number into parts that add up to it bit for bit in single precision, in any order: each is a multiple of
/// the number's last bit. Rounds the cumulative sums of the parts, not the parts, so that the errors do not add up.
class ExactParts {
 public:
  /// Domain     finite and not 0
  explicit ExactParts(double whole) : last_bit_(std::ldexp(1.0, std::ilogb(whole) - 23)), units_(whole / last_bit_) {}

  /// The next part, with which the parts add up to `sum`, rounded.
  ///
  /// `is_clamped`  the parts must not be negative, nor exceed the number together
  double next(double sum, bool is_clamped) {
    const double units = std::nearbyint(sum / last_bit_);
    return up_to(is_clamped ? std::clamp(units, so_far_, units_) : units);
  }
  /// The last part: what the others leave.
  double rest() { return up_to(units_); }

 private:
  double up_to(double units) {
    const double part = (units - so_far_) * last_bit_;
    so_far_ = units;
    return part;
  }

  double last_bit_, units_, so_far_ = 0;
};

/// The mean radiance of a pixel by light group and lobe. The lobes, the groups, and the lobes of the groups each sum to
/// the beauty, the lobes of a group to the group, and a lobe's cells over all groups to that lobe: bit for bit in
/// single precision, in any order.
///
/// Each cell is a multiple of the beauty's last bit, and no partial sum exceeds the beauty, so that all sums are exact.
///
/// Precision  the error of a cell or lobe is less than one ulp of the beauty, that of a group less than kLobes ulps
class LightCells {
 public:
  /// Divides the mean radiance of a pixel.
  ///
  /// `light`    the sums of the pixel's LayerRequest::light_cells()
  /// Domain     `beauty` is the sum over the same paths; rounding may make it differ from the sum of the light events
  LightCells(const LayerRequest& request, std::span<const LayerSums::Channels> light, const kernel::PixelSum& beauty);

  float of(std::size_t group, kernel::Lobe lobe, std::size_t channel) const;  ///< a lobe of a group
  float of_lobe(kernel::Lobe lobe, std::size_t channel) const;                ///< a lobe, all groups
  float of_group(std::size_t group, std::size_t channel) const;               ///< a group, all lobes

 private:
  double& cell(std::size_t group, std::size_t lobe, std::size_t channel) {
    return values_[(group * kernel::kLobes + lobe) * 3 + channel];
  }
  void divide(const LayerRequest& request, std::span<const LayerSums::Channels> light, const kernel::PixelSum& beauty,
              std::size_t channel);

  std::size_t groups_;
  std::vector<double> values_;
};

}  // namespace orrery::film
