// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "film/layer_pixel.h"
#include "film/layers.h"
#include "kernel/pixel_sum.h"

namespace orrery::film {

/// The mean radiance of a pixel, divided by light group and lobe, so that three divisions of the light add up to the
/// beauty bit for bit in single precision and in any order: the lobes, the groups, and the lobes of the groups. The
/// lobes of a group add up to the group, and the groups' parts of a lobe to the lobe.
///
/// Each cell is a multiple of the beauty's last bit, and no partial sum exceeds the beauty, so that all sums are exact.
/// With a filter that has negative lobes a partial sum can exceed it.
///
/// Precision  a cell or lobe is off by less than the last bit of the beauty, a group by less than kLobes of it
class LightCells {
 public:
  /// Domain     `beauty` is the sum of the same paths. Rounding may make it differ from the sum of the light events.
  LightCells(const LayerRequest& request, const LayerPixel& pixel, const kernel::PixelSum& beauty);

  float of(std::size_t group, kernel::Lobe lobe, std::size_t channel) const;
  float of_lobe(kernel::Lobe lobe, std::size_t channel) const;   ///< of all groups
  float of_group(std::size_t group, std::size_t channel) const;  ///< all lobes

 private:
  double& cell(std::size_t group, std::size_t lobe, std::size_t channel) {
    return values_[(group * kernel::kLobes + lobe) * 3 + channel];
  }
  void divide(const LayerRequest& request, const LayerPixel& pixel, const kernel::PixelSum& beauty,
              std::size_t channel);

  std::size_t groups_;
  std::vector<double> values_;
};

}  // namespace orrery::film
