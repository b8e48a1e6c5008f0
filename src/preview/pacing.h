// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::preview {

/// Fraction of the render's processor time that updates may use. The limit of the whole preview is 1 %; the rest is for
/// the copies that rendering threads make, and for the last update, which is not delayed.
inline constexpr double kShareOfTime = 0.003;

/// Decides when a preview is updated: once per interval, and less often if updates are expensive.
class Pacing {
 public:
  /// Starts without any updates.
  ///
  /// `interval_s`   minimum time between updates
  explicit Pacing(double interval_s) : interval_s_(interval_s) {}

  /// True if an update is due. It is assumed to cost as much as the last one.
  ///
  /// `now_s`        time since the render began
  /// `processor_s`  processor time of all threads since then
  bool is_due(double now_s, double processor_s) const noexcept {
    return now_s >= last_s_ + interval_s_ && spent_s_ + last_cost_s_ <= kShareOfTime * processor_s;
  }

  /// Records an update, and the processor time that it took.
  void updated(double now_s, double cost_s) noexcept {
    last_s_ = now_s;
    last_cost_s_ = cost_s;
    spent_s_ += cost_s;
  }

  /// Records processor time that was spent between updates.
  void spend(double cost_s) noexcept { spent_s_ += cost_s; }

 private:
  double interval_s_;
  double last_s_ = 0, last_cost_s_ = 0, spent_s_ = 0;
};

}  // namespace orrery::preview
