// SPDX-License-Identifier: Apache-2.0
// How long Embree takes to build over spheres, spheres a second on all threads, and how much memory it takes.
#include <benchmark/benchmark.h>

#include <string>

#include "support/workload.h"

namespace orrery::bench {
namespace {

void build(benchmark::State& state, std::uint64_t spheres) {
  const auto& world = workload<kernel::RayPacket>(spheres, kernel::Precision::kExact).world;
  std::size_t bytes = 0;
  for (auto _ : state) {
    const auto accel = accel::make_embree(world.view(), world.precision);
    bytes = accel->bytes();
  }
  const auto count = static_cast<double>(world.spheres.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(world.spheres.size()));
  state.counters["bytes_per_sphere"] = static_cast<double>(bytes) / count;
}

[[maybe_unused]] const bool kRegistered = [] {
  for (std::uint64_t n = 10; n <= 1'000'000; n *= 10)
    benchmark::RegisterBenchmark(("accel/build/embree/" + std::to_string(n)).c_str(), build, n)->UseRealTime();
  return true;
}();

}  // namespace
}  // namespace orrery::bench
