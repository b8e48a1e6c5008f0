// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "display/develop.h"

namespace orrery::display {

/// Points along each edge of a baked cube: 65 is what most programs take, 33 what monitors do.
inline constexpr int kDefaultCubeSize = 65;

/// A display transform with exposure, look and view as a table for other programs: the text of a Resolve .cube file. A
/// shaper of one dimension takes light from 0 to 2^kBakedStops times that of mid grey, logarithmically, to the cube.
///
/// Precision  test DisplayBake.ACubeDoesWhatTheViewDoes
/// Errors     as choose
std::string bake_cube(const Settings& settings, int size);

/// The same as the text of a Common LUT Format file: OCIO's own steps, without any loss, where the format has words for
/// all of them; tables as in bake_cube where it lacks one, as for the ACES views.
///
/// Errors     as choose
std::string bake_clf(const Settings& settings, int size);

}  // namespace orrery::display
