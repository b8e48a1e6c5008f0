// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "kernel/forward.h"
#include "render/forward.h"
#include "study/bench.h"

namespace orrery::study {

/// The quartiles of measurements, linearly interpolated between the two nearest values.
///
/// Domain     at least one value
Quartiles quartiles(std::vector<double> values);

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

/// Benchmark of closest-hit queries on the same rays: packets and single rays with the structure that the number of
/// spheres decides, then with the alternative one (one Embree primitive per sphere, or a SphereBvh); single rays with
/// Embree's built-in sphere points; and a SIMD list.
class TracingBench {
 public:
  /// Builds the remaining accelerators.
  ///
  /// Domain     the view and the rays outlive this; at least one sphere
  TracingBench(const kernel::SceneView& view, render::RecordedRays<float>& rays, bool with_list);

  /// Measures every method once. Each round starts with a different one.
  void measure(int round);

  std::vector<BenchTracing> results() const;

 private:
  struct Method {
    std::string name;
    const accel::Accel* accel;
    accel::Traversal traversal;
    std::vector<double> rays_per_s;
  };

  std::unique_ptr<accel::Accel> by_count_;  ///< the structure that the number of spheres decides
  std::unique_ptr<accel::Accel> other_, points_, list_;
  render::RecordedRays<float>& rays_;
  double ray_count_ = 0;
  std::vector<Method> methods_;
};

}  // namespace orrery::study
