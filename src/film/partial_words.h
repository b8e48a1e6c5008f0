// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "film/partial.h"

namespace orrery::film {

/// A partial as 32-bit words, for files: a head, then a plane of each word of each number over all pixels, or
/// its one value where all pixels have the same.
std::vector<std::uint32_t> to_words(const Partial& partial);

/// The same backwards; words after the end are padding.
///
/// Domain     any words; spheres of layers are not compared with a scene
/// Errors     base::Error(kBadData) where they are no partial of this size
Partial from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px);

}  // namespace orrery::film
