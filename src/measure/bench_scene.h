// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/quartiles.h"
#include "job/scene_source.h"

namespace orrery::measure {

struct BenchRequest {
  job::SceneSource scene;
  std::string isa;  ///< empty: the best
  int threads = 1;
  int rounds = 7;         ///< each round measures every case once
  double seconds = 0.25;  ///< of one measurement, at least
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(int done, int total)> on_progress;  ///< measurements
};

/// One way to render the scene.
struct BenchCase {
  std::string name;  ///< "embree fast"
  Quartiles paths_per_s;
  Quartiles ratio;  ///< of paths a second to those of "embree exact" in the same round
  /// Part of its time that tracing its rays alone needs; with one thread and a hierarchy only.
  std::optional<Quartiles> tracing;
};

/// One way to find the hits of the rays that a render in `fast` has traced.
struct BenchTracing {
  std::string name;  ///< "sphere points, single rays"
  Quartiles rays_per_s;
  Quartiles ratio;  ///< of rays a second to those of the first way in the same round
};

/// What was measured, in one run whose rounds alternate between all cases.
struct Benchmark {
  std::string scene_hash, isa, accelerator;
  std::uint64_t spheres = 0;
  double rays_per_path = 0;
  int width = 0, height = 0;  ///< px; of the small picture that is rendered
  int threads = 0, rounds = 0;
  std::vector<BenchCase> cases;       ///< first "embree exact"
  std::vector<BenchTracing> tracing;  ///< with one thread only
  std::vector<BenchCase> features;    ///< exact, as if the scene had one feature more; named by it
  std::vector<std::string> left_out;  ///< what was not measured, and why
};

/// Renders the scene, at a small size, in every precision by Embree and by the list, and measures how fast that is.
///
/// Errors     as format::read_scene; base::Error(kStopped) where `cancel` stopped it, kUsage for an unknown `isa`
Benchmark bench_scene(const BenchRequest& request);

/// A feature of the kernel.
struct FeatureCost {
  std::string name;       ///< "thin lens"
  bool required = false;  ///< by the scene
  double saves = 0;       ///< if it is not required: of the time that a render with it would take, median
};

/// Renders the scene, small and exact, as it is and as if it had each feature more, in turn.
///
/// Result     all features; those that the scene requires are not measured
/// Errors     as bench_scene
std::vector<FeatureCost> bench_features(const BenchRequest& request);

/// For people.
std::string benchmark_text(const Benchmark& benchmark);
/// As JSON, "orrery.bench/1".
std::string benchmark_json(const Benchmark& benchmark);

}  // namespace orrery::measure
