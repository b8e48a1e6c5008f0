// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace orrery::base {

/// Measures time, in seconds.
class Stopwatch {
 public:
  /// Seconds since the last lap, or since the construction.
  double seconds() const { return seconds_until(Clock::now()); }

  /// Returns the same, and starts again.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double out = seconds_until(now);
    begin_ = now;
    return out;
  }

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_until(Clock::time_point end) const { return std::chrono::duration<double>(end - begin_).count(); }

  Clock::time_point begin_ = Clock::now();
};

}  // namespace orrery::base
