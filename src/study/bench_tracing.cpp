// SPDX-License-Identifier: Apache-2.0
#include "study/bench_tracing.h"

#include <cstddef>

#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"
#include "render/recorded_rays.h"
#include "study/bench_build.h"
#include "study/bench_scene.h"

namespace orrery::study {

TracingBench::TracingBench(const kernel::SceneView& view, render::RecordedRays<float>& rays, bool with_list)
    : points_(accel::make_native_points(view)), rays_(rays) {
  const AlternativeAccelerator other = alternative_accelerator(view);
  by_count_ = accel::make_embree(view, kernel::Precision::kFast);
  other_ = accel::make_embree(view, kernel::Precision::kFast, {}, other.bvh_threshold);
  for (const auto* packets : {&rays_.camera, &rays_.secondary})
    for (const kernel::RayPacket<float>& packet : *packets) ray_count_ += packet.count;
  methods_ = {{"packets", by_count_.get(), accel::Traversal::kPacket, {}},
              {"single rays", by_count_.get(), accel::Traversal::kSingle, {}},
              {other.name + ", packets", other_.get(), accel::Traversal::kPacket, {}},
              {other.name + ", single", other_.get(), accel::Traversal::kSingle, {}},
              {"sphere points", points_.get(), accel::Traversal::kSingle, {}}};
  if (!with_list) return;
  list_ = accel::make_simd_list(view, kernel::Precision::kFast);
  methods_.push_back({"SIMD list", list_.get(), accel::Traversal::kPacket, {}});
}

void TracingBench::measure(int round) {
  for (std::size_t i = 0; i < methods_.size(); ++i) {
    Method& method = methods_[(i + static_cast<std::size_t>(round)) % methods_.size()];
    const kernel::Tracer tracer = method.accel->tracer(method.traversal);
    method.rays_per_s.push_back(
        ray_count_ / (render::trace_again(tracer, rays_.camera) + render::trace_again(tracer, rays_.secondary)));
  }
}

std::vector<BenchTracing> TracingBench::results() const {
  std::vector<BenchTracing> out;
  for (const Method& method : methods_) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < method.rays_per_s.size(); ++i)
      ratios.push_back(method.rays_per_s[i] / methods_.front().rays_per_s[i]);
    out.push_back({method.name, quartiles(method.rays_per_s), quartiles(ratios)});
  }
  return out;
}

}  // namespace orrery::study
