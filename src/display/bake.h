// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "display/develop.h"
#include "display/settings.h"

namespace orrery::display {

/// Grid points per axis of a baked 3D LUT. Most programs accept 65, monitors 33.
inline constexpr int kDefaultCubeSize = 65;

/// Bakes a display transform (exposure, look and view) to a 3D LUT, as the text of a Resolve .cube file. A 1D shaper
/// LUT maps radiance from 0 to 7 stops above mid grey logarithmically to the domain of the 3D LUT.
///
/// Errors     those of choose
/// Precision  test DisplayBake.ACubeMatchesTheView
std::string bake_cube(const Settings& settings, int size);

/// The same transform as the text of a Common LUT Format (CLF) file. It is stored exactly if the format supports all of
/// its ops; otherwise, e.g. for the ACES views, it is baked to LUTs as in bake_cube().
///
/// Errors     those of choose
std::string bake_clf(const Settings& settings, int size);

}  // namespace orrery::display
