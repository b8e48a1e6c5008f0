// SPDX-License-Identifier: Apache-2.0
// Instances of the path loop for scenes with features.lit; used by render_tile.cpp.
#pragma once

#include "kernel/render_tile.h"

namespace orrery::kernel {

/// Returns the lit loop for the best enabled instruction set, with or without records, in `exact` or `fast`. Camera and
/// spheres may move.
RenderTile lit_tile_function(bool records);
RenderTileFast lit_tile_fast_function(bool records);

}  // namespace orrery::kernel
