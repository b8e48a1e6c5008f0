// SPDX-License-Identifier: Apache-2.0
// Rendering the book's final scene in paths per second, from compiled scene to finished image.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>

#include "baseline/program.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/scenes.h"

namespace orrery::bench {
namespace {

using kernel::Precision;

struct Size {
  int width, height, samples;

  std::int64_t paths() const { return std::int64_t{width} * height * samples; }
};
constexpr Size kLarge{480, 270, 4};
/// For the slow cases. Embree is also measured at this size, because BVH build and partly filled packets weigh more in
/// a small image.
constexpr Size kSmall{96, 54, 8};

void render(benchmark::State& state, Size size, compile::Accelerator accelerator, Precision precision, int threads) {
  compile::CompiledScene compiled = compile_for(final_scene(size.width, size.height, size.samples), precision);
  compiled.accelerator = accelerator;
  render::Settings settings;
  settings.threads = threads;
  double rays = 0;
  for (auto _ : state) {
    const render::Result result = render::render(compiled, settings);
    benchmark::DoNotOptimize(result.picture.planes.data());
    rays += static_cast<double>(result.statistics.rays);
  }
  const std::int64_t paths = state.iterations() * size.paths();
  state.SetItemsProcessed(paths);
  state.counters["rays_per_path"] = rays / static_cast<double>(paths);
}

void render_baseline(benchmark::State& state, Size size, baseline::Spheres spheres) {
  baseline::Program program(final_scene(size.width, size.height, size.samples), spheres);
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const auto pixels = program.render(++seed);
    benchmark::DoNotOptimize(pixels.data());
  }
  const std::int64_t paths = state.iterations() * size.paths();
  state.SetItemsProcessed(paths);
  state.counters["rays_per_path"] = static_cast<double>(program.rays()) / static_cast<double>(paths);
}

void register_render(const std::string& name, Size size, compile::Accelerator accelerator, Precision precision,
                     int threads) {
  auto* const registered = benchmark::RegisterBenchmark(("render/final_scene/" + name).c_str(), render, size,
                                                        accelerator, precision, threads);
  registered->Unit(benchmark::kMillisecond);
  // A single thread is the calling thread, and its CPU time excludes other processes on the machine.
  if (threads != 1) registered->UseRealTime();
}

[[maybe_unused]] const bool kRegistered = [] {
  using compile::Accelerator;
  for (const Precision precision : {Precision::kExact, Precision::kFast, Precision::kBook}) {
    const std::string mode = name_of(precision);
    register_render("list/" + mode + "/one_thread/small", kSmall, Accelerator::kList, precision, 1);
    if (precision == Precision::kBook) continue;
    register_render("embree/" + mode + "/one_thread", kLarge, Accelerator::kEmbree, precision, 1);
    register_render("embree/" + mode + "/all_threads", kLarge, Accelerator::kEmbree, precision, 0);
    register_render("embree/" + mode + "/one_thread/small", kSmall, Accelerator::kEmbree, precision, 1);
  }
  benchmark::RegisterBenchmark("render/final_scene/baseline/one_thread/small", render_baseline, kSmall,
                               baseline::Spheres::kList)
      ->Unit(benchmark::kMillisecond);
  for (const auto& [name, size] : {std::pair{"one_thread", kLarge}, std::pair{"one_thread/small", kSmall}})
    benchmark::RegisterBenchmark((std::string("render/final_scene/native_points/") + name).c_str(), render_baseline,
                                 size, baseline::Spheres::kNativePoints)
        ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace orrery::bench
