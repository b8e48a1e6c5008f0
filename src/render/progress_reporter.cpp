// SPDX-License-Identifier: Apache-2.0
#include "render/progress_reporter.h"

#include <algorithm>
#include <utility>

#include "film/partial.h"
#include "render/progress.h"
#include "render/settings.h"

namespace orrery::render {

ProgressReporter::ProgressReporter(const Settings& settings, std::uint64_t total, const film::RenderWork& before)
    : settings_(settings), seconds_before_(before.seconds), done_(before.paths), total_(total) {}

double ProgressReporter::seconds() const {
  if (settings_.clock) return seconds_before_ + settings_.clock(done());
  return seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count();
}

void ProgressReporter::expect(std::uint64_t total, std::string goal) {
  const std::lock_guard lock(mutex_);
  total_ = std::max(total, done());
  goal_ = std::move(goal);
}

void ProgressReporter::add(std::uint64_t samples) {
  const std::uint64_t done = done_.fetch_add(samples, std::memory_order_relaxed) + samples;
  if (!settings_.on_progress) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // another thread is reporting
  const double now = seconds();
  double fraction = static_cast<double>(done) / static_cast<double>(std::max<std::uint64_t>(total_, 1));
  if (!goal_.empty() && settings_.sampling.seconds > 0)
    fraction = std::max(fraction, std::min(now / settings_.sampling.seconds, 0.99));
  const int percent = static_cast<int>(std::min(fraction, 1.0) * 100);
  if (now - last_ < kInterval && percent == last_percent_ && done < total_) return;
  last_ = now;
  last_percent_ = percent;
  if (goal_.empty()) return settings_.on_progress({done, total_, now, goal_});
  max_reported_ = std::min(std::max(max_reported_, fraction), 1.0);
  const auto total = max_reported_ >= 1 ? done : static_cast<std::uint64_t>(static_cast<double>(done) / max_reported_);
  settings_.on_progress({done, std::max(total, done), now, goal_});
}

}  // namespace orrery::render
