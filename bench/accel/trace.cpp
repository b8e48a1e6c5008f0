// SPDX-License-Identifier: Apache-2.0
// Closest-hit queries in rays per second: Embree, the list, the book's program and Embree's sphere points, on rays
// recorded from a render.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "baseline/program.h"
#include "kernel/ray_packet.h"
#include "support/workload.h"

namespace orrery::bench {
namespace {

using kernel::Precision;

enum class Rays { kCamera, kBounced };
enum class Method { kEmbree, kList };

template <class T>
std::vector<kernel::RayPacket<T>>& choose(RecordedRays<T>& rays, Rays which) {
  return which == Rays::kCamera ? rays.camera : rays.secondary;
}

/// One packet per iteration.
template <class T>
void trace(benchmark::State& state, std::uint64_t spheres, Precision precision, Rays which, Method method) {
  auto& work = workload<T>(spheres, precision);
  auto& packets = choose(work.rays, which);
  const kernel::Tracer tracer = (method == Method::kEmbree ? work.embree : work.list)->tracer();
  std::int64_t rays = 0;
  std::size_t next = 0;
  for (auto _ : state) {
    kernel::RayPacket<T>& packet = packets[next];
    kernel::reset_hits(packet);
    kernel::trace(tracer, packet);
    rays += packet.count;
    next = next + 1 == packets.size() ? 0 : next + 1;
  }
  state.SetItemsProcessed(rays);
}

/// The rays of the recorded packets as single rays.
std::vector<baseline::Ray> single_rays(const std::vector<kernel::RayPacket<double>>& packets) {
  std::vector<baseline::Ray> rays;
  for (const kernel::RayPacket<double>& p : packets) {
    for (int i = 0; i < p.count; ++i)
      rays.push_back({{p.origin[0][i], p.origin[1][i], p.origin[2][i]},
                      {p.direction[0][i], p.direction[1][i], p.direction[2][i]}});
  }
  return rays;
}

/// One ray per iteration, through the book's list of virtual objects or Embree's sphere points.
void trace_baseline(benchmark::State& state, std::uint64_t spheres, Rays which, baseline::Spheres how) {
  auto& work = workload<double>(spheres, Precision::kExact);
  const baseline::Program program(work.scene, how);
  const std::vector<baseline::Ray> rays = single_rays(choose(work.rays, which));
  std::size_t next = 0;
  for (auto _ : state) {
    baseline::HitRecord record;
    bool hit = program.compiled().hit(rays[next], {0.001, std::numeric_limits<double>::infinity()}, record);
    benchmark::DoNotOptimize(hit);
    benchmark::DoNotOptimize(record);
    next = next + 1 == rays.size() ? 0 : next + 1;
  }
  state.SetItemsProcessed(state.iterations());
}

void register_trace(const std::string& name, std::uint64_t spheres, Precision precision, Rays which, Method method) {
  const auto run = precision == Precision::kFast ? trace<float> : trace<double>;
  benchmark::RegisterBenchmark(name.c_str(), run, spheres, precision, which, method);
}

/// Above this size the list takes too long to measure.
constexpr std::uint64_t kLongestList = 10'000;

[[maybe_unused]] const bool kRegistered = [] {
  for (const Rays which : {Rays::kCamera, Rays::kBounced}) {
    const std::string rays = which == Rays::kCamera ? "camera" : "bounced";
    const auto name = [&](const std::string& scene, const std::string& how, const std::string& size) {
      return "accel/trace/" + scene + "/" + rays + "/" + how + size;
    };
    for (const Precision precision : {Precision::kExact, Precision::kFast, Precision::kBook}) {
      const std::string mode = name_of(precision);
      register_trace(name("final", "list/" + mode, ""), 0, precision, which, Method::kList);
      if (precision == Precision::kBook) continue;
      register_trace(name("final", "embree/" + mode, ""), 0, precision, which, Method::kEmbree);
    }
    benchmark::RegisterBenchmark(name("final", "baseline", "").c_str(), trace_baseline, 0u, which,
                                 baseline::Spheres::kList);
    benchmark::RegisterBenchmark(name("final", "native_points", "").c_str(), trace_baseline, 0u, which,
                                 baseline::Spheres::kNativePoints);
    for (std::uint64_t n = 1; n <= 1'000'000; n *= 10) {
      const std::string size = "/" + std::to_string(n);
      for (const Precision precision : {Precision::kExact, Precision::kFast}) {
        const std::string mode = name_of(precision);
        register_trace(name("cloud", "embree/" + mode, size), n, precision, which, Method::kEmbree);
        if (n <= kLongestList) register_trace(name("cloud", "list/" + mode, size), n, precision, which, Method::kList);
      }
      if (n <= kLongestList)
        benchmark::RegisterBenchmark(name("cloud", "baseline", size).c_str(), trace_baseline, n, which,
                                     baseline::Spheres::kList);
      benchmark::RegisterBenchmark(name("cloud", "native_points", size).c_str(), trace_baseline, n, which,
                                   baseline::Spheres::kNativePoints);
    }
  }
  return true;
}();

}  // namespace
}  // namespace orrery::bench
