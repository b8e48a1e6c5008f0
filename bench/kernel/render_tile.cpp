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

using kernel::Precision;

template <class T>
void run(benchmark::State& state, Precision precision, kernel::RenderTile render) {
  auto& work = workload<T>(0, precision);
  std::vector<kernel::PixelSum> sums(std::size_t{kRecordedWidth} * kRecordedHeight);
  const auto stream = std::make_unique<kernel::PathStream>();
  const kernel::Tracer tracer = work.embree->tracer();
  const kernel::SceneView view = work.compiled.view();
  kernel::Tile tile{.width = kRecordedWidth, .height = kRecordedHeight, .sample_end = kRecordedSamples};
  tile.sums = sums.data();
  tile.row_stride = kRecordedWidth;
  std::uint64_t rays = 0;
  for (auto _ : state) rays += render(view, tracer, tile, *stream).rays;
  const std::int64_t paths = state.iterations() * kRecordedWidth * kRecordedHeight * kRecordedSamples;
  state.SetItemsProcessed(paths);
  state.counters["rays_per_path"] = static_cast<double>(rays) / static_cast<double>(paths);
}

[[maybe_unused]] const bool kRegistered = [] {
  const auto add = [](const char* name, auto function) {
    benchmark::RegisterBenchmark((std::string("kernel/render_tile/") + name).c_str(), function)
        ->Unit(benchmark::kMillisecond);
  };
  add("exact/one_lane",
      [](benchmark::State& state) { run<double>(state, Precision::kExact, test::one_lane_tile_function()); });
  add("exact/all_lanes", [](benchmark::State& state) {
    run<double>(state, Precision::kExact, kernel::render_tile_function({}, Precision::kExact, false));
  });
  add("fast/all_lanes", [](benchmark::State& state) {
    run<float>(state, Precision::kFast, kernel::render_tile_function({}, Precision::kFast, false));
  });
  return true;
}();

}  // namespace
}  // namespace orrery::bench
