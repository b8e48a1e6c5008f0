// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "film/film.h"
#include "kernel/render_tile.h"

namespace orrery::render {

/// Cuts a picture into tiles small enough to be shared out evenly and to stop soon, large enough that a tile's first
/// and last packets don't matter. Pictures with many samples are cut finer than 32 pixels.
///
/// Result     all pixels once, each with all its samples, row by row
std::vector<kernel::Tile> make_tiles(int width, int height, int samples, film::Film& film);

}  // namespace orrery::render
