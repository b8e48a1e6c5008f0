// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/filter_tables.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Returns the tables for importance sampling of a pixel filter: the inverse of its integral.
///
/// Reference  mitchell1988; harris1978 for the Blackman-Harris window
FilterTables compile_filter(const scene::Render& render);

/// Returns the full width of the filter in pixels, as set or by default.
double filter_width(const scene::Render& render);

}  // namespace orrery::compile
