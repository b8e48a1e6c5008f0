// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "kernel/forward.h"
#include "render/recorded_rays.h"
#include "study/bench.h"

namespace orrery::study {

/// The quartiles of measurements, linearly interpolated between the two nearest values.
///
/// Domain     at least one value
Quartiles quartiles(std::vector<double> values);
/// The quartiles of the quotients of measurements in the same rounds.
Quartiles ratios(const std::vector<double>& values, const std::vector<double>& reference);

/// Calls `measure` for each item. Each round starts with a different one.
template <class Item, class Measure>
void measure_round(std::vector<Item>& items, int round, Measure measure) {
  for (std::size_t i = 0; i < items.size(); ++i) measure(items[(i + static_cast<std::size_t>(round)) % items.size()]);
}

/// Seconds for tracing recorded rays without camera, shading and accumulation.
template <class T>
double trace_again(const kernel::Tracer& tracer, render::RecordedRays<T>& rays) {
  return render::trace_again(tracer, rays.camera) + render::trace_again(tracer, rays.secondary);
}

/// Benchmarks accelerator builds on all threads: the accelerator that renders the scene in `exact`, an alternative one
/// (one Embree primitive per sphere, or a SphereBvh), and Embree's built-in sphere points.
///
/// `rounds`   maximum number of rounds; fewer are run if they take seconds
/// Domain     at least one sphere
/// Result     sphere points are last
std::vector<BenchResult> bench_builds(const kernel::SceneView& view, int rounds);

/// Benchmark of closest-hit queries on the same rays: packets and single rays with the structure that the number of
/// spheres decides, then with the alternative one; single rays with Embree's built-in sphere points; and a SIMD list.
class TracingBench {
 public:
  /// Builds the remaining accelerators.
  ///
  /// Domain     the view and the rays outlive this; at least one sphere
  TracingBench(const kernel::SceneView& view, render::RecordedRays<float>& rays, bool with_list);

  /// Measures every method once.
  void measure(int round);
  std::vector<BenchResult> results() const;

 private:
  struct Method {
    std::string name;
    std::shared_ptr<const accel::Accel> accel;
    accel::Traversal traversal;
    std::vector<double> rays_per_s = {};
  };

  render::RecordedRays<float>& rays_;
  double ray_count_ = 0;
  std::vector<Method> methods_;
};

}  // namespace orrery::study
