// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/filter_tables.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Integrates a filter and turns the integral round.
///
/// Reference  mitchell1988; harris1978 for the window of Blackman and Harris
FilterTables compile_filter(const scene::Render& render);

/// Full width of a filter in pixels, as authored or by default.
double filter_width(const scene::Render& render);

}  // namespace orrery::compile
