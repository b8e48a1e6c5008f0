// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

/// A scene, and its duplicates, which are never hit: the view's may be found again while the list is in use.
struct DistinctObjects {
  kernel::SceneView view;
  std::vector<std::uint32_t> duplicates;
};

/// The queries of the naive list.
///
/// Result     `self` is to be set to DistinctObjects
kernel::Tracer list_tracer(kernel::Precision precision);

}  // namespace orrery::accel
