// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/scene_view.h"
#include "measure/bench_scene.h"

namespace orrery::measure {

/// Benchmark of building, on all threads: the accelerator that renders the scene in `exact`, the other kind (one Embree
/// primitive per sphere, or a SphereBvh), and Embree's own sphere points. Rounds alternate between them.
///
/// `rounds`   maximum number of rounds; there are fewer if they take seconds
/// Domain     at least one sphere
/// Result     sphere points are the last
std::vector<BenchBuild> bench_builds(const kernel::SceneView& view, int rounds);

}  // namespace orrery::measure
