// SPDX-License-Identifier: Apache-2.0
// Instances of the path loop that only tests and benchmarks need.
#pragma once

#include "kernel/render_tile.h"

namespace orrery::test {

/// The plain path loop in `exact` with one lane: the reference for those with all lanes.
kernel::RenderTile one_lane_tile_function();

}  // namespace orrery::test
