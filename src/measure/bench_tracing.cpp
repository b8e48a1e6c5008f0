// SPDX-License-Identifier: Apache-2.0
#include "measure/bench_tracing.h"

#include <cstddef>

namespace orrery::measure {

TracingBench::TracingBench(const kernel::SceneView& view, accel::Accel& fast,
                           render::RecordedRays<kernel::RayPacketFast>& rays, bool with_list)
    : points_(accel::make_native_points(view)), rays_(rays) {
  for (const auto* packets : {&rays_.camera, &rays_.bounced})
    for (const kernel::RayPacketFast& packet : *packets) ray_count_ += packet.count;
  ways_ = {{"packets", &fast, accel::Traversal::kPacket, {}},
           {"single rays", &fast, accel::Traversal::kSingle, {}},
           {"sphere points", points_.get(), accel::Traversal::kSingle, {}}};
  if (!with_list) return;
  list_ = accel::make_simd_list(view, kernel::Precision::kFast);
  ways_.push_back({"SIMD list", list_.get(), accel::Traversal::kPacket, {}});
}

void TracingBench::measure(int round) {
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    Way& way = ways_[(i + static_cast<std::size_t>(round)) % ways_.size()];
    way.accel->use({way.traversal, way.traversal});
    const kernel::Tracer tracer = way.accel->tracer();
    way.rays_per_s.push_back(ray_count_ /
                             (render::trace_again(tracer, rays_.camera) + render::trace_again(tracer, rays_.bounced)));
  }
}

std::vector<BenchTracing> TracingBench::results() const {
  std::vector<BenchTracing> out;
  for (const Way& way : ways_) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < way.rays_per_s.size(); ++i)
      ratios.push_back(way.rays_per_s[i] / ways_.front().rays_per_s[i]);
    out.push_back({way.name, quartiles(way.rays_per_s), quartiles(ratios)});
  }
  return out;
}

}  // namespace orrery::measure
