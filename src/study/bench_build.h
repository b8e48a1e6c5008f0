// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernel/forward.h"

namespace orrery::study {

struct BenchBuild;

/// The accelerator that a benchmark compares with the default one: one Embree primitive per sphere if the default has a
/// BVH of many spheres, otherwise such a BVH.
struct AlternativeAccelerator {
  std::string name;
  std::size_t bvh_threshold;  ///< for accel::make_embree
};
AlternativeAccelerator alternative_accelerator(const kernel::SceneView& view);

/// Benchmarks accelerator builds on all threads: the accelerator that renders the scene in `exact`, the alternative
/// one, and Embree's built-in sphere points. Rounds alternate between them.
///
/// `rounds`   maximum number of rounds; fewer are run if they take seconds
/// Domain     at least one sphere
/// Result     sphere points are last
std::vector<BenchBuild> bench_builds(const kernel::SceneView& view, int rounds);

}  // namespace orrery::study
