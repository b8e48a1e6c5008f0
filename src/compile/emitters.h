// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/forward.h"
#include "kernel/precision.h"

namespace orrery::compile {

/// Removes spheres that coincide with an earlier sphere of the scene, whether that emits or not. The accelerators skip
/// them (see accel::duplicates), so they emit no light.
///
/// `ids`      ascending
/// Result     ascending
/// Cost       none if there are no ids, or if the scene is known to have no coincident spheres; else see
///            base::find_duplicates, for the spheres up to the last id
std::vector<std::uint32_t> without_coincident(const kernel::SceneView& scene, kernel::Precision precision,
                                              std::vector<std::uint32_t> ids);

}  // namespace orrery::compile
