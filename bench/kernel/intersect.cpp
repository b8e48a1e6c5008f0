// SPDX-License-Identifier: Apache-2.0
// Ray-sphere intersection alone: intersection tests per second, and hit points per second.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "kernel/intersect_lanes.h"
#include "support/workload.h"

namespace orrery::bench {
namespace {

using kernel::Precision;
using test::Lanes;

/// Spheres that a packet is tested against in one iteration; they and the packet fit into the L1 cache.
constexpr std::size_t kSpheres = 64;
/// Packets whose hit points are computed in one iteration.
constexpr std::size_t kPackets = 16;

IntersectFunctions<double> functions_for(double, Precision p, Lanes l) { return intersect_double(p, l); }
IntersectFunctions<float> functions_for(float, Precision, Lanes l) { return intersect_float(l); }

/// Full packets of sixteen secondary rays each, from the book's final scene.
template <class T>
std::vector<kernel::RayPacket<T>> full_packets(const Workload<T>& work) {
  std::vector<kernel::RayPacket<T>> full;
  for (const kernel::RayPacket<T>& packet : work.rays.secondary) {
    if (packet.count == kernel::kPacketSize) full.push_back(packet);
    if (full.size() == kPackets) break;
  }
  return full;
}

/// The sphere that each ray has hit; an arbitrary sphere for rays that missed.
template <class T>
SphereLanes<T> spheres_of(const compile::CompiledScene& compiled, const kernel::RayPacket<T>& packet) {
  SphereLanes<T> out;
  for (int i = 0; i < kernel::kPacketSize; ++i) {
    const bool none = packet.hit[i] == kernel::kNone;
    const kernel::Sphere s = compiled.spheres[none ? 0 : static_cast<std::size_t>(packet.hit[i])];
    out.center[0][i] = static_cast<T>(s.x);
    out.center[1][i] = static_cast<T>(s.y);
    out.center[2][i] = static_cast<T>(s.z);
    out.radius[i] = static_cast<T>(s.radius);
  }
  return out;
}

template <class T>
void closest_distance(benchmark::State& state, Precision precision, Lanes lanes) {
  auto& work = workload<T>(0, precision);
  const auto functions = functions_for(T(), precision, lanes);
  kernel::RayPacket<T> packet = full_packets(work).front();
  for (auto _ : state) {
    kernel::reset_hits(packet);
    functions.closest_distance(packet, work.compiled.spheres.view().plain, kSpheres);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSpheres) * kernel::kPacketSize);
}

template <class T>
void hit_point(benchmark::State& state, Precision precision, Lanes lanes) {
  auto& work = workload<T>(0, precision);
  const auto functions = functions_for(T(), precision, lanes);
  const std::vector<kernel::RayPacket<T>> packets = full_packets(work);
  std::vector<SphereLanes<T>> spheres;
  for (const auto& packet : packets) spheres.push_back(spheres_of(work.compiled, packet));
  PointLanes<T> out;
  for (auto _ : state) {
    for (std::size_t i = 0; i < packets.size(); ++i) {
      functions.hit_point(packets[i], spheres[i], out);
      benchmark::DoNotOptimize(out);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(packets.size()) * kernel::kPacketSize);
}

[[maybe_unused]] const bool kRegistered = [] {
  for (const Precision precision : {Precision::kExact, Precision::kFast, Precision::kBook}) {
    for (const Lanes lanes : {Lanes::kOne, Lanes::kAll}) {
      const bool fast = precision == Precision::kFast;
      const std::string end = "/" + name_of(precision) + (lanes == Lanes::kOne ? "/one_lane" : "/all_lanes");
      benchmark::RegisterBenchmark(("kernel/intersect/nearest" + end).c_str(),
                                   fast ? closest_distance<float> : closest_distance<double>, precision, lanes);
      benchmark::RegisterBenchmark(("kernel/intersect/hit_point" + end).c_str(),
                                   fast ? hit_point<float> : hit_point<double>, precision, lanes);
    }
  }
  return true;
}();

}  // namespace
}  // namespace orrery::bench
