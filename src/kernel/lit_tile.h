// SPDX-License-Identifier: Apache-2.0
// Instances of the path loop for scenes with features.lit; used by render_tile.cpp.
#pragma once

#include "kernel/render_tile.h"

namespace orrery::kernel {

/// The lit loop for the best enabled instruction set, with records or without, in `exact` or `fast`. Camera and spheres
/// may move.
RenderTile lit_tile_function(bool records);
RenderTileFast lit_tile_fast_function(bool records);

}  // namespace orrery::kernel
