// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/diagnostic.h"
#include "scene/scene.h"

namespace orrery::plot {

/// Spheres of a frame, and warnings about the data and the options.
struct LoadedFrame {
  scene::Points points;
  std::vector<base::Diagnostic> warnings;
};

}  // namespace orrery::plot
