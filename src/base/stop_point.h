// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

namespace orrery::base {

/// During its lifetime, a flag can stop long computations that this thread starts.
class StopScope {
 public:
  /// Sets the flag of this thread.
  ///
  /// `flag`     true stops the computations; null: nothing stops them. Must outlive the scope
  explicit StopScope(const std::atomic<bool>* flag) noexcept;
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const std::atomic<bool>* before_;
};

/// A cancellation point of a long computation. Holds the flag of the innermost StopScope of the thread that created it,
/// and can check it on any thread. Outside any scope, it never stops.
class StopPoint {
 public:
  StopPoint() noexcept;

  /// Stops the computation if the flag is set.
  ///
  /// Errors     base::Error(kStopped)
  void check() const {
    if (flag_ != nullptr && flag_->load(std::memory_order_relaxed)) fail();
  }

  /// Checks every kSteps steps, for loops over many short steps.
  void check(std::size_t step) const {
    if (step % kSteps == 0) check();
  }

 private:
  static constexpr std::size_t kSteps = 1 << 20;
  [[noreturn]] static void fail();

  const std::atomic<bool>* flag_;
};

}  // namespace orrery::base
