// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

/// A scene, and the ids of its duplicate spheres, which are never hit.
struct DistinctSpheres {
  kernel::SceneView view;
  std::vector<std::uint32_t> duplicates;
};

/// The queries of the naive list.
///
/// Result     `self` is to be set to DistinctSpheres
kernel::Tracer list_tracer(kernel::Precision precision);

}  // namespace orrery::accel
