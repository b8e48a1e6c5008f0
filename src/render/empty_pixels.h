// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "compile/forward.h"
#include "film/forward.h"

namespace orrery::render {

class TilePool;

/// Finds pixels whose camera rays hit nothing, by the bounds of all objects in the image. If the background is the same
/// in all directions, all paths of these pixels are alike.
///
/// Result     a mask in row-major order; empty if no pixel can be excluded, the background depends on the direction, or
///            the layers need records of paths
/// Cost       about 50 ns per object
std::vector<bool> find_empty_pixels(const compile::CompiledScene& compiled, const film::LayerRequest& layers,
                                    TilePool& pool);

}  // namespace orrery::render
