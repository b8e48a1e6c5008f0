// SPDX-License-Identifier: Apache-2.0
// The path loop in paths per second on one thread, with one lane and with all lanes; both use Embree's packets.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/render_tile.h"
#include "support/tile_functions.h"
#include "support/workload.h"

namespace orrery::bench {
namespace {

using kernel::Lanes;
using kernel::Precision;

template <class Packet, class Stream, class Render>
void run(benchmark::State& state, Precision precision, Render render) {
  auto& work = workload<Packet>(0, precision);
  std::vector<kernel::PixelSum> sums(std::size_t{kRecordedWidth} * kRecordedHeight);
  const auto stream = std::make_unique<Stream>();
  const kernel::Tracer tracer = work.embree->tracer();
  const kernel::SceneView view = work.compiled.view();
  std::uint64_t rays = 0;
  for (auto _ : state) {
    rays += render(view, tracer,
                   {0, 0, kRecordedWidth, kRecordedHeight, 0, kRecordedSamples, sums.data(), kRecordedWidth}, *stream)
                .rays;
  }
  const std::int64_t paths = state.iterations() * kRecordedWidth * kRecordedHeight * kRecordedSamples;
  state.SetItemsProcessed(paths);
  state.counters["rays_per_path"] = static_cast<double>(rays) / static_cast<double>(paths);
}

void in_double(benchmark::State& state, Precision precision, Lanes lanes) {
  run<kernel::RayPacket, kernel::PathStream>(
      state, precision,
      lanes == Lanes::kOne ? test::one_lane_tile_function({}, precision) : kernel::render_tile_function({}, precision));
}
void in_float(benchmark::State& state) {
  run<kernel::RayPacketFast, kernel::PathStreamFast>(state, Precision::kFast, kernel::render_tile_fast_function({}));
}

[[maybe_unused]] const bool kRegistered = [] {
  for (const Precision precision : {Precision::kExact, Precision::kBook}) {
    for (const Lanes lanes : {Lanes::kOne, Lanes::kAll}) {
      benchmark::RegisterBenchmark(
          ("kernel/render_tile/" + name_of(precision) + (lanes == Lanes::kOne ? "/one_lane" : "/all_lanes")).c_str(),
          in_double, precision, lanes)
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::RegisterBenchmark("kernel/render_tile/fast/all_lanes", in_float)->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace orrery::bench
