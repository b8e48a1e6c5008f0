// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "measure/bench_scene.h"
#include "render/recorded_rays.h"

namespace orrery::measure {

/// Finds the hits of the same rays in several ways, and does nothing else: packets and single rays through our user
/// geometry, single rays through Embree's own sphere points, and a list in all lanes.
class TracingBench {
 public:
  /// Domain     view, `fast`, its hierarchy for that precision, and rays outlive this; one sphere or more
  TracingBench(const kernel::SceneView& view, accel::Accel& fast, render::RecordedRays<kernel::RayPacketFast>& rays,
               bool with_list);

  /// Measures every way once; each round begins with another one.
  void measure(int round);

  std::vector<BenchTracing> results() const;

 private:
  struct Way {
    std::string name;
    accel::Accel* accel;
    accel::Traversal traversal;
    std::vector<double> rays_per_s;
  };

  std::unique_ptr<accel::Accel> points_, list_;
  render::RecordedRays<kernel::RayPacketFast>& rays_;
  double ray_count_ = 0;
  std::vector<Way> ways_;
};

}  // namespace orrery::measure
