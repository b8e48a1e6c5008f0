// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/lat_long_map.h"

namespace orrery::compile {

/// Adds the levels of a mip map to an image texture: each has half the width and height of the one before, rounded
/// down. A texel is the mean of those that it covers, by solid angle, so that all levels have the same mean over the
/// sphere, and those of a constant image equal it bit for bit.
///
/// The last level has at least 16 rows and 32 columns: a coarser one would mix the sphere's visible side with its far
/// side.
///
/// Precision  sums in double, rounded to float
void add_mip_map(scene::LatLongMap& image);

/// Returns the memory of an image of this size and its mip map, in bytes.
std::uint64_t mip_map_bytes(int width, int height);

}  // namespace orrery::compile
