// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/pixel_filter.h"

namespace orrery::compile {

/// A pixel filter's tables; empty for the pixel's own square, which needs none.
struct FilterTables {
  std::vector<double> above, below;
  double below_mass = 0;  ///< of one axis, the integral of the part below zero by that of the part above

  /// Valid as long as this is neither changed nor destroyed.
  kernel::PixelFilter view() const noexcept;
};

}  // namespace orrery::compile
