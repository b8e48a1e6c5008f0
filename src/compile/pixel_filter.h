// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/camera.h"
#include "scene/forward.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Tables for importance sampling of a pixel filter; empty for the box filter of width 1, which needs none.
struct FilterTables {
  std::vector<double> above, below;
  double below_mass = 0;  ///< per axis: integral of the negative part divided by that of the positive part

  /// Returns a view for the kernel; valid until this object is modified or destroyed.
  kernel::PixelFilter view() const noexcept;
};

/// Returns the inverse cumulative distributions of the positive and negative parts of a pixel filter, for importance
/// sampling.
///
/// Reference  mitchell1988; harris1978 for the Blackman-Harris window
FilterTables compile_filter(const scene::Render& render);

/// Returns the full width of the filter in pixels: as set in the scene, or the default of its type.
double filter_width(const scene::Render& render);

}  // namespace orrery::compile
