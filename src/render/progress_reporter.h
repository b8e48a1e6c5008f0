// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "film/forward.h"

namespace orrery::render {

struct Settings;

/// Reports progress to the caller, on the rendering threads: at each whole percent, and at most ten times a second in
/// between.
class ProgressReporter {
 public:
  /// Starts the clock.
  ///
  /// `total`    expected number of samples to render
  /// `before`   work of earlier runs
  ProgressReporter(const Settings& settings, std::uint64_t total, const film::RenderWork& before);

  /// Counts rendered samples.
  void add(std::uint64_t samples);

  /// Updates the estimated total of samples and what will end the render. Only between iterations. Reported progress
  /// never decreases.
  void expect(std::uint64_t total, std::string goal);

  /// Rendering time, including earlier runs.
  double seconds() const;
  std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kInterval = 0.1;  // seconds
  const Settings& settings_;
  double seconds_before_;
  std::atomic<std::uint64_t> done_;
  std::mutex mutex_;  // guards the members below
  std::uint64_t total_;
  std::string goal_;
  double max_reported_ = 0;  ///< 0..1
  double last_ = 0;          ///< time of the last report, seconds
  int last_percent_ = -1;    ///< last reported
  Clock::time_point start_ = Clock::now();
};

}  // namespace orrery::render
