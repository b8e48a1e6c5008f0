// SPDX-License-Identifier: Apache-2.0
#include "study/bench_build.h"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "accel/accel.h"
#include "kernel/scene_view.h"
#include "study/bench_scene.h"

namespace orrery::study {
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
  if (accel::spheres_in_bvh(view) > 0) return {"one by one", accel::kNoBvh};
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

}  // namespace orrery::study
