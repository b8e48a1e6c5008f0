// SPDX-License-Identifier: Apache-2.0
#include "study/bench_parts.h"

#include <algorithm>
#include <functional>

#include "base/stopwatch.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::study {
namespace {

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

/// No further round of builds begins after this time.
constexpr double kLongest = 3;  // s

/// The accelerator that a benchmark compares with the default one: one Embree primitive per sphere if the default has a
/// BVH of many spheres, otherwise such a BVH.
struct AlternativeAccelerator {
  std::string name;
  std::size_t bvh_threshold;  ///< for accel::make_embree
};

AlternativeAccelerator alternative_accelerator(const kernel::SceneView& view) {
  if (accel::objects_in_bvh(view).all() > 0) return {"one by one", accel::kNoBvh};
  return {"BVH", 1};
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

Quartiles ratios(const std::vector<double>& values, const std::vector<double>& reference) {
  std::vector<double> out;
  for (std::size_t i = 0; i < reference.size(); ++i) out.push_back(values[i] / reference[i]);
  return quartiles(std::move(out));
}

std::vector<BenchResult> bench_builds(const kernel::SceneView& view, int rounds) {
  struct Method {
    std::string name;
    std::function<std::unique_ptr<accel::Accel>()> build;
    std::vector<double> seconds = {}, spheres_per_s = {};
    std::size_t bytes = 0;
  };
  const AlternativeAccelerator other = alternative_accelerator(view);
  const auto embree = [&](std::size_t threshold) {
    return [&view, threshold] { return accel::make_embree(view, kernel::Precision::kExact, {}, threshold); };
  };
  std::vector<Method> methods = {{"accelerator", embree(accel::bvh_threshold())},
                                 {other.name, embree(other.bvh_threshold)},
                                 {"sphere points", [&view] { return accel::make_native_points(view); }}};
  const auto count = static_cast<double>(view.sphere_count);
  const base::Stopwatch since_begin;
  for (int round = 0; round < rounds && (round == 0 || since_begin.seconds() < kLongest); ++round)
    measure_round(methods, round, [&](Method& method) {
      const base::Stopwatch watch;
      const std::unique_ptr<accel::Accel> built = method.build();
      method.seconds.push_back(watch.seconds());
      method.spheres_per_s.push_back(count / method.seconds.back());
      method.bytes = built->bytes();
    });
  std::vector<BenchResult> out;
  for (const Method& method : methods)
    out.push_back({method.name,
                   quartiles(method.spheres_per_s),
                   ratios(method.seconds, methods.back().seconds),
                   {},
                   static_cast<double>(method.bytes) / count});
  return out;
}

TracingBench::TracingBench(const kernel::SceneView& view, render::RecordedRays<float>& rays, bool with_list)
    : rays_(rays) {
  for (const auto* packets : {&rays_.camera, &rays_.secondary})
    for (const kernel::RayPacket<float>& packet : *packets) ray_count_ += packet.count;
  const AlternativeAccelerator other = alternative_accelerator(view);
  const std::shared_ptr<const accel::Accel> by_count = accel::make_embree(view, kernel::Precision::kFast);
  const std::shared_ptr<const accel::Accel> alternative =
      accel::make_embree(view, kernel::Precision::kFast, {}, other.bvh_threshold);
  methods_ = {{"packets", by_count, accel::Traversal::kPacket},
              {"single rays", by_count, accel::Traversal::kSingle},
              {other.name + ", packets", alternative, accel::Traversal::kPacket},
              {other.name + ", single", alternative, accel::Traversal::kSingle},
              {"sphere points", accel::make_native_points(view), accel::Traversal::kSingle}};
  if (with_list)
    methods_.push_back({"SIMD list", accel::make_simd_list(view, kernel::Precision::kFast), accel::Traversal::kPacket});
}

void TracingBench::measure(int round) {
  measure_round(methods_, round, [&](Method& method) {
    method.rays_per_s.push_back(ray_count_ / trace_again(method.accel->tracer(method.traversal), rays_));
  });
}

std::vector<BenchResult> TracingBench::results() const {
  std::vector<BenchResult> out;
  for (const Method& method : methods_)
    out.push_back({method.name, quartiles(method.rays_per_s), ratios(method.rays_per_s, methods_.front().rays_per_s)});
  return out;
}

}  // namespace orrery::study
