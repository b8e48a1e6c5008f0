// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
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

/// Result of one render configuration.
struct BenchCase {
  std::string name;  ///< "embree fast"
  Quartiles paths_per_s;
  Quartiles ratio;  ///< speed relative to "embree exact" in the same round
  /// Fraction of the render time that tracing the same rays takes on its own; only with one thread and a BVH.
  std::optional<Quartiles> tracing;
};

/// Result of one traversal method on the recorded rays of a render in `fast`.
struct BenchTracing {
  std::string name;  ///< "sphere points"
  Quartiles rays_per_s;
  Quartiles ratio;  ///< speed relative to the first method in the same round
};

/// Result of building one accelerator.
struct BenchBuild {
  std::string name;  ///< "sphere points"
  Quartiles spheres_per_s;
  Quartiles ratio;              ///< time relative to Embree's sphere points in the same round
  double bytes_per_sphere = 0;  ///< memory of the accelerator, excluding the spheres
};

/// Results of a benchmark whose rounds alternate between all cases.
struct Benchmark {
  std::string scene_hash, isa, accelerator;
  std::uint64_t spheres = 0;
  double rays_per_path = 0;
  int width = 0, height = 0;  ///< reduced image size, px
  int threads = 0, rounds = 0;
  std::vector<BenchCase> cases;       ///< "embree exact" is the first
  std::vector<BenchTracing> tracing;  ///< with one thread only
  std::vector<BenchBuild> builds;     ///< on all threads
  std::vector<BenchCase> features;    ///< embree exact with one feature added that the scene lacks; named after it
  std::vector<std::string> left_out;  ///< what was not measured, and why
};

/// Measures the render speed of a scene at a reduced size, in every precision, with Embree and with the list.
///
/// Errors     those of format::read_scene; base::Error(kStopped) after `cancel`, kUsage for an unknown $ORRERY_ISA
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
