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

/// A supervisor that hears nothing for longer takes a render for hung.
inline constexpr std::chrono::milliseconds kHeartbeat{60'000};

/// Tells how far a render is: one line with a bar, or a line whenever the whole percent changes and at the latest when
/// the heartbeat's time has passed, also while the scene is read and while a tile takes its time.
class ProgressPrinter {
 public:
  /// Domain     `to` stays open as long as this lives
  ProgressPrinter(ProgressStyle style, std::FILE* to, std::chrono::milliseconds heartbeat = kHeartbeat);
  ~ProgressPrinter();
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  /// To be called from any thread.
  void update(const ProgressState& state);

  /// What is done of building the hierarchy, 0..1, where a bar is shown; lines are of samples only. From any thread.
  void building(double fraction);

  /// A message of whole lines between two of progress, or above the bar; from any thread.
  void note(const std::string& text);

  /// Takes the bar away, so that the next message has its line, and ends the heartbeat.
  void finish();

 private:
  void print_line();
  void print_bar();
  void beat();

  ProgressStyle style_;
  std::FILE* to_;
  std::chrono::milliseconds heartbeat_;
  std::mutex mutex_;  // of all below
  std::condition_variable wake_;
  ProgressState state_;
  int last_percent_ = -1;
  std::chrono::steady_clock::time_point last_line_ = std::chrono::steady_clock::now();
  bool bar_shown_ = false;
  bool finished_ = false;
  std::thread beating_;
};

}  // namespace orrery::cli
