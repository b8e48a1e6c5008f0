// SPDX-License-Identifier: Apache-2.0
// Instances of the path loop that only tests and benchmarks need.
#pragma once

#include "kernel/render_tile.h"
#include "kernel/scene_view.h"

namespace orrery::test {

/// kernel::render_tile_function with one lane: the reference for those with all lanes.
kernel::RenderTile one_lane_tile_function(const kernel::Features& features, kernel::Precision precision);

}  // namespace orrery::test
