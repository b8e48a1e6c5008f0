// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/pixel_filter.h"

namespace orrery::compile {

/// Tables to sample a pixel filter; empty for the box of width 1, which needs no table.
struct FilterTables {
  std::vector<double> above, below;
  double below_mass = 0;  ///< per axis: integral of the negative part divided by that of the positive part

  /// Returns a view for the kernel; valid until this object is modified or destroyed.
  kernel::PixelFilter view() const noexcept;
};

}  // namespace orrery::compile
