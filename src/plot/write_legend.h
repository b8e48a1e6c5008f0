// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "display/develop.h"
#include "scene/scene.h"

namespace orrery::plot {

/// Writes the legend of a plot's colours: a complete one as SVG, or the bar of the colour map alone as an image. The
/// colours go through the display transform of the image, so that they match it.
///
/// `points`   loaded spheres with a colour map, or with colours by type or element
/// `display`  of the image; its working space is not used
/// Errors     base::Error: kUsage for another extension, and if the points have no colours that a legend can explain;
///            those of display::develop; kCannotCreate, kIo
void write_legend(const std::filesystem::path& file, const scene::Points& points, const display::Settings& display);

}  // namespace orrery::plot
