// SPDX-License-Identifier: Apache-2.0
// Instances of the path loop for scenes with features.extended; used by render_tile.cpp.
#pragma once

#include "kernel/render_tile.h"

namespace orrery::kernel {

/// Returns the lit loop with textures and rough glass for the best enabled instruction set, with or without records.
/// Camera and spheres may move.
RenderTile extended_tile_function(bool records, Precision precision);
RenderTileFast extended_tile_fast_function(bool records);

}  // namespace orrery::kernel
