// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace orrery::base {

/// Maximum image width and height, px: a pixel id is y << 16 | x.
inline constexpr int kLargestSide = 65536;

/// Maximum number of light groups: in the layer `light_groups` each takes 384 bytes of memory per pixel (8 lobes, 3
/// channels, 16 bytes per sum) and 27 channels in the file.
inline constexpr std::size_t kMaxLightGroups = 64;

}  // namespace orrery::base
