// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "display/develop.h"

namespace orrery::display {

/// Points along each edge of a baked cube. Most programs accept 65, monitors 33.
inline constexpr int kDefaultCubeSize = 65;

/// Bakes a display transform (exposure, look and view) to the text of a Resolve .cube file. A one-dimensional shaper
/// maps radiance from 0 to 7 stops above mid grey logarithmically to the cube.
///
/// Precision  test DisplayBake.ACubeMatchesTheView
/// Errors     as choose
std::string bake_cube(const Settings& settings, int size);

/// The same as the text of a Common LUT Format file. The transforms are stored exactly if the format supports all of
/// them; otherwise, as for the ACES views, LUTs as in bake_cube().
///
/// Errors     as choose
std::string bake_clf(const Settings& settings, int size);

}  // namespace orrery::display
