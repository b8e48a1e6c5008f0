// SPDX-License-Identifier: Apache-2.0
// Compares accelerators on the rays of one scene: bench_tracing SCENE [ROUNDS]. Prints JSON: closest hits per second of
// recorded rays, in single precision on one thread, and times and memory of builds on all threads, for the accelerator
// that the number of spheres decides, the alternative, Embree's sphere points, and the SIMD list if it is affordable.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "accel/accel.h"
#include "base/stopwatch.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "job/resources.h"
#include "kernel/isa.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "support/comparison.h"
#include "support/recorded_rays.h"

namespace orrery::bench {
namespace {

using kernel::Precision;
using nlohmann::json;

constexpr double kPixels = 96 * 54;
/// Every kRecordedRows-th row is recorded: about ten thousand paths, so that the recorded rays fit into the caches.
constexpr int kRecordedRows = 4;
/// Largest scene that is traced with the list.
constexpr std::size_t kLongestList = 100'000;
/// No further round of builds begins after this time.
constexpr double kLongestBuilds = 3;  // s

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// A way to trace or to build, and its measurements: seconds of each round.
struct Method {
  std::string name;
  std::function<double()> measure;
  std::vector<double> seconds = {};
  double bytes = 0;
};

/// Measures all methods in each round, starting with a different one. `work` is what a measurement processes.
json measured(std::vector<Method>& methods, int rounds, double longest_s, const char* speed, double work) {
  const base::Stopwatch watch;
  for (int round = 0; round < rounds && (round == 0 || watch.seconds() < longest_s); ++round)
    for (std::size_t i = 0; i < methods.size(); ++i) {
      Method& method = methods[(i + static_cast<std::size_t>(round)) % methods.size()];
      method.seconds.push_back(method.measure());
    }
  json out = json::array();
  for (const Method& method : methods) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < method.seconds.size(); ++i)
      ratios.push_back(method.seconds[i] / methods.front().seconds[i]);
    out.push_back({{"name", method.name}, {speed, work / median(method.seconds)}, {"relative_time", median(ratios)}});
    if (method.bytes > 0) out.back()["bytes_per_sphere"] = method.bytes / work;
  }
  return out;
}

std::vector<kernel::Tile> recorded_rows(const compile::CompiledScene& compiled) {
  std::vector<kernel::Tile> rows;
  for (int y = 0; y < compiled.height; y += kRecordedRows) {
    kernel::Tile& row = rows.emplace_back();
    row.y = y;
    row.width = compiled.width;
    row.height = 1;
    row.sample_end = kernel::kPacketSize;
  }
  return rows;
}

json results_of(const std::string& scene, int rounds) {
  job::choose_isa();
  load::SceneRequest request;
  request.source.file = scene;
  load::ReadResult read = std::move(load::load_scene(request).read);
  load::reduce_picture(read, kPixels);
  compile::CompiledScene compiled = compile::compile(read.scene);
  compiled.precision = Precision::kFast;
  const kernel::SceneView view = compiled.view();
  const auto count = static_cast<double>(compiled.spheres.size());
  // One Embree primitive per sphere if the default has a BVH of many spheres, otherwise such a BVH.
  const bool has_bvh = accel::objects_in_bvh(view).all() > 0;
  const std::string other = has_bvh ? "one by one" : "BVH";
  const std::size_t other_threshold = has_bvh ? accel::kNoBvh : 1;

  std::vector<Method> builds;
  const auto add_build = [&](const std::string& name, auto make) {
    builds.push_back({name, [&builds, make, i = builds.size()] {
                        const base::Stopwatch watch;
                        const std::unique_ptr<accel::Accel> built = make();
                        const double seconds = watch.seconds();
                        builds[i].bytes = static_cast<double>(built->bytes());
                        return seconds;
                      }});
  };
  add_build("sphere points", [&] { return accel::make_native_points(view); });
  add_build("accelerator", [&] { return accel::make_embree(view, Precision::kExact); });
  add_build(other, [&] { return accel::make_embree(view, Precision::kExact, {}, other_threshold); });

  const std::shared_ptr<const accel::Accel> by_count = accel::make_embree(view, Precision::kFast);
  const std::shared_ptr<const accel::Accel> alternative =
      accel::make_embree(view, Precision::kFast, {}, other_threshold);
  RecordedRays<float> rays = record_rays<float>(view, *by_count, Precision::kFast, recorded_rows(compiled));
  double ray_count = 0;
  for (const auto* packets : {&rays.camera, &rays.secondary})
    for (const kernel::RayPacket<float>& packet : *packets) ray_count += packet.count;
  std::vector<Method> traversals;
  const auto add_traversal = [&](const std::string& name, std::shared_ptr<const accel::Accel> accel,
                                 accel::Traversal how) {
    traversals.push_back({name, [&rays, accel = std::move(accel), how] {
                            const kernel::Tracer tracer = accel->tracer(how);
                            return trace_again(tracer, rays.camera) + trace_again(tracer, rays.secondary);
                          }});
  };
  add_traversal("packets", by_count, accel::Traversal::kPacket);
  add_traversal("single rays", by_count, accel::Traversal::kSingle);
  add_traversal(other + ", packets", alternative, accel::Traversal::kPacket);
  add_traversal(other + ", single", alternative, accel::Traversal::kSingle);
  add_traversal("sphere points", accel::make_native_points(view), accel::Traversal::kSingle);
  if (compiled.spheres.size() <= kLongestList)
    add_traversal("SIMD list", accel::make_simd_list(view, Precision::kFast), accel::Traversal::kPacket);

  return {{"spheres", compiled.spheres.size()},
          {"isa", kernel::isa_name()},
          {"tracing", measured(traversals, rounds, 1e9, "rays_per_s", ray_count)},
          {"builds", measured(builds, rounds, kLongestBuilds, "spheres_per_s", count)}};
}

}  // namespace
}  // namespace orrery::bench

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fputs("usage: bench_tracing SCENE [ROUNDS]\n", stderr);
    return 2;
  }
  try {
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 7;
    std::puts(orrery::bench::results_of(argv[1], rounds).dump(2).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_tracing: %s\n", error.what());
    return 1;
  }
}
