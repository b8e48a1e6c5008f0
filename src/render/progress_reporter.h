// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "render/render.h"

namespace orrery::render {

/// Reports progress to the caller, from whichever thread has just done some of it: at each whole percent, and between
/// these ten times a second at most.
class ProgressReporter {
 public:
  /// `total` samples are to be done, as far as is known; `before` was done by earlier runs.
  ProgressReporter(const Settings& settings, std::uint64_t total, const film::RenderWork& before = {})
      : settings_(settings), seconds_before_(before.seconds), done_(before.paths), total_(total) {}

  /// Samples were done.
  void add(std::uint64_t samples);

  /// A better guess of the samples that will be needed, and what ends the render; between rounds only. What was told
  /// before is not taken back: a bar that went backwards would say less than one that waits.
  void expect(std::uint64_t total, std::string goal);

  /// Of rendering, those of earlier runs among them.
  double seconds() const;
  std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kInterval = 0.1;  // seconds
  const Settings& settings_;
  double seconds_before_;
  std::atomic<std::uint64_t> done_;
  std::mutex mutex_;  // of all below
  std::uint64_t total_;
  std::string goal_;
  double most_told_ = 0;   ///< 0..1
  double last_ = 0;        ///< report, seconds
  int last_percent_ = -1;  ///< that was reported
  Clock::time_point start_ = Clock::now();
};

}  // namespace orrery::render
