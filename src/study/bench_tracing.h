// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "kernel/forward.h"
#include "render/forward.h"

namespace orrery::study {

struct BenchTracing;

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
