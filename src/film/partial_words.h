// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::film {

struct Partial;

/// Serializes a partial render to 32-bit words: a header, then a plane over all pixels for each word of each per-pixel
/// number, or a single value if it is the same for all pixels.
std::vector<std::uint32_t> to_words(const Partial& partial);

/// Deserializes the result of to_words(). Words after the end are ignored as padding.
///
/// Domain     any words; sphere indices in layers are not checked against a scene
/// Errors     base::Error(kBadData) if the words are not a partial render of this size
Partial from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px);

}  // namespace orrery::film
