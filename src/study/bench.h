// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "load/load_scene.h"

namespace orrery::study {

/// Lower quartile, median and upper quartile.
struct Quartiles {
  double low = 0, median = 0, high = 0;
};

/// Scene and protocol of a benchmark.
struct BenchRequest {
  load::SceneSource scene;
  int threads = 1;
  int rounds = 7;         ///< number of rounds; each measures every case once
  double seconds = 0.25;  ///< minimum duration of one measurement
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(int done, int total)> on_progress;  ///< called after each measurement
};

/// The speed of one configuration.
struct BenchResult {
  std::string name;  ///< "embree fast", "sphere points"
  Quartiles speed;   ///< paths, rays or spheres per second
  Quartiles ratio;   ///< to a reference in the same round
  /// Of renders with one thread and a BVH: fraction of the time that tracing the same rays takes on its own.
  std::optional<Quartiles> tracing = {};
  double bytes_per_sphere = 0;  ///< of builds: memory of the accelerator, excluding the spheres
};

/// Results of a benchmark whose rounds alternate between all cases.
struct Benchmark {
  std::string scene_hash, isa, accelerator;
  std::uint64_t spheres = 0;
  double rays_per_path = 0;
  int width = 0, height = 0;  ///< reduced image size, px
  int threads = 0, rounds = 0;
  std::vector<BenchResult> cases;  ///< renders; the ratio is that of speeds to "embree exact", which is the first
  /// Closest-hit queries on the recorded rays of a render in `fast`, with one thread only; ratio of speeds to the
  /// first.
  std::vector<BenchResult> tracing;
  std::vector<BenchResult> builds;    ///< on all threads; ratio of times to Embree's sphere points
  std::vector<BenchResult> features;  ///< embree exact with one feature added that the scene lacks; named after it
  std::vector<std::string> left_out;  ///< what was not measured, and why
};

/// Measures the render speed of a scene at a reduced size, in every precision, with Embree and with the list.
///
/// Errors     those of load::load_scene; base::Error(kStopped) after `cancel`, kUsage for an unknown $ORRERY_ISA
Benchmark bench_scene(const BenchRequest& request);

/// A benchmark as a text table.
std::string benchmark_text(const Benchmark& benchmark);
/// A benchmark as JSON, schema "orrery.bench/1".
std::string benchmark_json(const Benchmark& benchmark);

/// The cost of an optional kernel feature.
struct FeatureCost {
  std::string name;       ///< "thin lens"
  bool required = false;  ///< the scene needs it
  double saves = 0;       ///< if not required: fraction of the time with the feature that omitting it saves, median
};

/// Measures the cost of each kernel feature that the scene lacks, in embree exact at a reduced size.
///
/// Result     all features; those that the scene requires are not measured
/// Errors     those of bench_scene
std::vector<FeatureCost> bench_features(const BenchRequest& request);

}  // namespace orrery::study
