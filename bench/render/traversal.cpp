// SPDX-License-Identifier: Apache-2.0
// The traversals that the rule chooses, packets for all rays and single rays for all, in paths per second on one
// thread, BVH build excluded, with each wide instruction set: accel::fastest_traversals.
#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "kernel/isa.h"
#include "kernel/ray_packet.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/scenes.h"

namespace orrery::bench {
namespace {

using kernel::Precision;

constexpr int kWidth = 240, kHeight = 135;  // px
/// One packet of camera rays per pixel.
constexpr int kSamples = kernel::kPacketSize;

using MakeScene = std::function<scene::Scene()>;

/// A scene for one instruction set and precision, with its accelerator.
struct Subject {
  compile::CompiledScene compiled;
  std::unique_ptr<accel::Accel> embree;
};

void render(benchmark::State& state, const std::string& name, const MakeScene& make, const std::string& isa,
            Precision precision, std::optional<accel::Traversal> traversal) {
  if (!kernel::limit_isa(isa)) return state.SkipWithError("this processor does not have it");
  static std::map<std::string, Subject> subjects;
  Subject& subject = subjects[name];
  if (!subject.embree) {
    subject.compiled = compile_for(make(), precision);
    subject.embree = render::build(subject.compiled, render::available_threads());
  }
  render::Settings settings;
  settings.threads = 1;
  settings.traversal = traversal;
  for (auto _ : state) {
    const render::Result result = render::render(subject.compiled, *subject.embree, settings);
    benchmark::DoNotOptimize(result.picture.planes.data());
    state.SetLabel(result.statistics.traversal);
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight * kSamples);
  kernel::limit_isa("");
}

void register_scene(const std::string& scene, const MakeScene& make) {
  for (const std::string& isa : kernel::available_isas()) {
    if (isa == "sse4") continue;
    for (const Precision precision : {Precision::kExact, Precision::kFast}) {
      const std::string name = "render/traversal/" + scene + "/" + isa + "/" + name_of(precision);
      const auto add = [&](const char* how, std::optional<accel::Traversal> traversal) {
        benchmark::RegisterBenchmark((name + "/" + how).c_str(), render, name, make, isa, precision, traversal)
            ->Unit(benchmark::kMillisecond);
      };
      add("rule", {});
      add("packets", accel::Traversal::kPacket);
      add("single", accel::Traversal::kSingle);
    }
  }
}

[[maybe_unused]] const bool kRegistered = [] {
  register_scene("final", [] { return final_scene(kWidth, kHeight, kSamples); });
  for (const int grid : {40, 200})
    register_scene("layer/" + std::to_string(4 * grid * grid),
                   [=] { return layer_scene(grid, kWidth, kHeight, kSamples); });
  for (const unsigned n : {100u, 1'000u, 10'000u, 100'000u, 1'000'000u})
    register_scene("cloud/" + std::to_string(n), [=] { return cloud_scene(n, kWidth, kHeight, kSamples); });
  for (const int cells : {3, 6, 14, 29, 63})
    register_scene("crystal/" + std::to_string(4 * cells * cells * cells),
                   [=] { return crystal_scene(cells, kWidth, kHeight, kSamples); });
  return true;
}();

}  // namespace
}  // namespace orrery::bench
