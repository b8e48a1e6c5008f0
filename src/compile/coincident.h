// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "compile/forward.h"

namespace orrery::compile {

/// Numbers (kernel::RodArray::object), ascending, of the spheres and rods that coincide with an earlier one: all of
/// their coordinates and radii are equal, in the number type of the scene's precision, throughout the shutter interval.
///
/// Errors     base::Error(kStopped) in a base::StopScope
/// Cost       see base::find_duplicates; for the spheres, none if CompiledScene::distinct_in says that all differ
std::vector<std::uint32_t> coincident_objects(const CompiledScene& scene);

}  // namespace orrery::compile
