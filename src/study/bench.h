// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
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
  std::string name;  ///< "embree fast"
  Quartiles speed;   ///< paths per second
  Quartiles ratio;   ///< to "embree exact" in the same round
};

/// Results of a benchmark whose rounds alternate between all cases.
struct Benchmark {
  std::string scene_hash, isa, accelerator;
  std::uint64_t spheres = 0;
  double rays_per_path = 0;
  int width = 0, height = 0;  ///< reduced image size, px
  int threads = 0, rounds = 0;
  std::vector<BenchResult> cases;     ///< the first is "embree exact"
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

}  // namespace orrery::study
