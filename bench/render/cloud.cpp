// SPDX-License-Identifier: Apache-2.0
// Rendering clouds of many small spheres, in paths per second on one thread, BVH build excluded: orrery, and the scalar
// loop on Embree's sphere points.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "baseline/program.h"
#include "kernel/ray_packet.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/scenes.h"

namespace orrery::bench {
namespace {

using kernel::Precision;

constexpr int kWidth = 240, kHeight = 135;  // px
/// One packet of camera rays per pixel, as in a render of any useful quality.
constexpr int kSamples = kernel::kPacketSize;
constexpr std::int64_t kPaths = std::int64_t{kWidth} * kHeight * kSamples;

/// A cloud with its accelerator, built on first use and cached, because building takes longer than rendering.
struct Cloud {
  compile::CompiledScene compiled;
  std::unique_ptr<accel::Accel> embree;

  Cloud(std::uint64_t spheres, Precision precision)
      : compiled(compile_for(cloud_scene(spheres, kWidth, kHeight, kSamples), precision)),
        embree(render::build(compiled, render::available_threads())) {}
};

void render(benchmark::State& state, std::uint64_t spheres, Precision precision) {
  static std::map<std::pair<std::uint64_t, Precision>, std::unique_ptr<Cloud>> known;
  auto& cloud = known[{spheres, precision}];
  if (!cloud) cloud = std::make_unique<Cloud>(spheres, precision);
  render::Settings settings;
  settings.threads = 1;
  double rays = 0;
  for (auto _ : state) {
    const render::Result result = render::render(cloud->compiled, *cloud->embree, settings);
    benchmark::DoNotOptimize(result.picture.planes.data());
    rays += static_cast<double>(result.statistics.rays);
  }
  state.SetItemsProcessed(state.iterations() * kPaths);
  state.counters["rays_per_path"] = rays / static_cast<double>(state.iterations() * kPaths);
}

void render_native_points(benchmark::State& state, std::uint64_t spheres) {
  static std::map<std::uint64_t, std::unique_ptr<baseline::Program>> known;
  auto& program = known[spheres];
  if (!program)
    program =
        std::make_unique<baseline::Program>(cloud_scene(spheres, kWidth, kHeight, 1), baseline::Spheres::kNativePoints);
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const auto pixels = program->render(++seed);
    benchmark::DoNotOptimize(pixels.data());
  }
  state.SetItemsProcessed(state.iterations() * kPaths / kSamples);
}

[[maybe_unused]] const bool kRegistered = [] {
  for (const std::uint64_t n : {1'000u, 100'000u, 1'000'000u, 10'000'000u}) {
    const std::string size = "/" + std::to_string(n);
    for (const Precision precision : {Precision::kExact, Precision::kFast})
      benchmark::RegisterBenchmark(("render/cloud/embree/" + name_of(precision) + size).c_str(), render, n, precision)
          ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("render/cloud/native_points" + size).c_str(), render_native_points, n)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace orrery::bench
