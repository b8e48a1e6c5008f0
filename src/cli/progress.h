// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

#include "cli/progress_text.h"

namespace orrery::cli {

/// Maximum time between two lines of progress, so that a supervisor does not consider a render hung.
inline constexpr std::chrono::milliseconds kHeartbeat{60'000};

/// Prints the progress of a render: a bar, or a line whenever the whole percent changes and at least once per
/// heartbeat, including while the scene is read and during a long tile.
class ProgressPrinter {
 public:
  /// Starts the heartbeat.
  ///
  /// Domain     `to` outlives this
  ProgressPrinter(ProgressStyle style, std::FILE* to, std::chrono::milliseconds heartbeat = kHeartbeat);
  ~ProgressPrinter();
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  /// Sets the progress to show. Thread-safe.
  void update(const ProgressState& state);

  /// Shows the finished fraction of the BVH build, 0..1, in the bar; lines show samples only. Thread-safe.
  void building(double fraction);

  /// Prints a message of whole lines between progress lines, or above the bar. Thread-safe.
  void note(const std::string& text);

  /// Clears the bar and ends the heartbeat.
  void finish();

 private:
  void print_line();
  void print_bar(const std::string& bar);
  void clear_bar();
  void print(const std::string& lines);
  void print_periodically();

  ProgressStyle style_;
  std::FILE* to_;
  std::chrono::milliseconds heartbeat_;
  std::mutex mutex_;  // guards all members below
  std::condition_variable wake_;
  ProgressState state_;
  int last_percent_ = -1;
  std::chrono::steady_clock::time_point last_line_ = std::chrono::steady_clock::now();
  bool bar_shown_ = false;
  bool finished_ = false;
  std::thread printing_thread_;
};

}  // namespace orrery::cli
