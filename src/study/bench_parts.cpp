// SPDX-License-Identifier: Apache-2.0
#include "study/bench_parts.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "accel/accel.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"
#include "render/recorded_rays.h"

namespace orrery::study {

namespace {

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

namespace {

/// No further round begins after this time.
constexpr double kLongest = 3;  // s

struct Method {
  std::string name;
  std::function<std::unique_ptr<accel::Accel>()> build;
  std::vector<double> seconds;
  std::size_t bytes = 0;
};

}  // namespace

AlternativeAccelerator alternative_accelerator(const kernel::SceneView& view) {
  if (accel::objects_in_bvh(view).all() > 0) return {"one by one", accel::kNoBvh};
  return {"BVH", 1};
}

std::vector<BenchBuild> bench_builds(const kernel::SceneView& view, int rounds) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  const AlternativeAccelerator other = alternative_accelerator(view);
  const auto embree = [&](std::size_t threshold) {
    return [&view, threshold] { return accel::make_embree(view, kernel::Precision::kExact, {}, threshold); };
  };
  std::vector<Method> methods = {{"accelerator", embree(accel::bvh_threshold()), {}},
                                 {other.name, embree(other.bvh_threshold), {}},
                                 {"sphere points", [&view] { return accel::make_native_points(view); }, {}}};
  const Clock::time_point start = Clock::now();
  for (int round = 0; round < rounds && (round == 0 || seconds_since(start) < kLongest); ++round) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
      // Each round starts with a different method.
      Method& method = methods[(i + static_cast<std::size_t>(round)) % methods.size()];
      const Clock::time_point begin = Clock::now();
      const std::unique_ptr<accel::Accel> built = method.build();
      method.seconds.push_back(seconds_since(begin));
      method.bytes = built->bytes();
    }
  }
  const auto count = static_cast<double>(view.sphere_count);
  std::vector<BenchBuild> out;
  for (const Method& method : methods) {
    std::vector<double> rates, ratios;
    for (std::size_t i = 0; i < method.seconds.size(); ++i) {
      rates.push_back(count / method.seconds[i]);
      ratios.push_back(method.seconds[i] / methods.back().seconds[i]);
    }
    out.push_back({method.name, quartiles(rates), quartiles(ratios), static_cast<double>(method.bytes) / count});
  }
  return out;
}

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
