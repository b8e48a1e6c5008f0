// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/forward.h"
#include "scene/scene.h"

namespace orrery::compile {

/// The inverse cumulative distribution of a pixel filter, see kernel::PixelFilter; empty for the box filter of width 1.
///
/// Reference  harris1978 for the Blackman-Harris window
std::vector<double> compile_filter(const scene::Render& render);

/// Returns the full width of the filter in pixels: as set in the scene, or the default of its type.
double filter_width(const scene::Render& render);

}  // namespace orrery::compile
