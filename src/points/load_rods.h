// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "points/load_points.h"
#include "scene/diagnostic.h"
#include "scene/forward.h"

namespace orrery::points {

/// Reads the rods of a data file, one per row: ends from the columns x0, y0, z0, x1, y1, z1, radii from `radius`,
/// unless the scene file sets it.
///
/// Result     diagnostics about keys of the scene file: missing columns; `rods` has none if one of them is an error
/// Errors     base::Error: those of formats::open and data::DataFile; kNoMemory
std::vector<scene::SceneDiagnostic> load_rods(const LoadRequest& request, scene::RodFile& rods);

}  // namespace orrery::points
