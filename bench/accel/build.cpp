// SPDX-License-Identifier: Apache-2.0
// BVH build speed in spheres per second on all threads, and memory of the finished BVH, for our user geometry and for
// Embree's sphere points.
#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <utility>

#include "accel/accel.h"
#include "support/comparison.h"
#include "support/scenes.h"

namespace orrery::bench {
namespace {

enum class Geometry { kUser, kNativePoints };

void build(benchmark::State& state, std::uint64_t spheres, Geometry geometry) {
  static std::map<std::uint64_t, compile::CompiledScene> known;
  compile::CompiledScene& compiled = known[spheres];
  if (compiled.spheres.empty()) compiled = compile_for(cloud_scene(spheres, 16, 16, 1), kernel::Precision::kExact);
  std::size_t bytes = 0;
  for (auto _ : state) {
    const auto accel = geometry == Geometry::kUser ? accel::make_embree(compiled.view(), compiled.precision)
                                                   : accel::make_native_points(compiled.view());
    bytes = accel->bytes();
  }
  const auto count = static_cast<double>(compiled.spheres.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(compiled.spheres.size()));
  state.counters["bytes_per_sphere"] = static_cast<double>(bytes) / count;
}

[[maybe_unused]] const bool kRegistered = [] {
  for (std::uint64_t n = 10; n <= 10'000'000; n *= 10) {
    for (const auto& [name, geometry] :
         {std::pair{"embree/", Geometry::kUser}, std::pair{"native_points/", Geometry::kNativePoints}}) {
      auto* const registered =
          benchmark::RegisterBenchmark(("accel/build/" + (name + std::to_string(n))).c_str(), build, n, geometry);
      registered->UseRealTime()->Unit(benchmark::kMillisecond);
      if (n == 10'000'000) registered->Iterations(1);  // takes ten seconds
    }
  }
  return true;
}();

}  // namespace
}  // namespace orrery::bench
