// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace orrery::cli {

/// Format of progress output.
enum class ProgressStyle {
  kAuto,    ///< the bar on a terminal, kArnold elsewhere
  kBar,     ///< one line that is overwritten
  kAlf,     ///< "ALF_PROGRESS 42%": Tractor
  kOpenJd,  ///< "openjd_progress: 42": Open Job Description, Deadline Cloud
  kArnold,  ///< "42% done", which farm managers parse from the logs of many renderers
  kJson,    ///< one JSON object per line
  kNone,
};

/// Names of the styles, in the order of the enumerators.
const std::vector<std::string>& progress_style_names();

/// The style with this name.
///
/// Domain     one of progress_style_names()
ProgressStyle progress_style(const std::string& name);

/// The progress of a render or of measurements.
struct ProgressState {
  std::uint64_t done = 0;   ///< samples
  std::uint64_t total = 1;  ///< samples
  double seconds = 0;       ///< since the start; 0: no rate and no time left are shown
  std::string goal = {};    ///< the target, as text; empty: the samples
  std::string phase = {};   ///< what is done before the first sample, such as "building"; empty: nothing
  double prepared = 0;      ///< progress of that phase, 0..1; 0: unknown

  double fraction() const;            ///< 0..1
  int percent() const;                ///< rounded down; 100 only when finished
  double samples_per_second() const;  ///< 0 if unknown
  double seconds_left() const;        ///< at the mean rate so far; negative if unknown
};

/// A line for a log or a farm manager, without newline.
///
/// Domain     a style that has lines: kAlf, kOpenJd, kArnold or kJson
std::string progress_line(ProgressStyle style, const ProgressState& state);

/// "[#####.....]  42 %  2.3 M samples/s  1:05 left", cut to the columns of the terminal.
std::string progress_bar(const ProgressState& state, int columns);

/// Maximum time between two lines of progress, so that a supervisor does not consider a render hung.
inline constexpr std::chrono::milliseconds kHeartbeat{60'000};

/// Prints the progress of a render: a bar, or a line whenever the whole percent changes, with kAuto every tenth, and at
/// least once per heartbeat, including while the scene is read and during a long tile.
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

  /// Shows what is done before the first sample: in the bar, and in the lines of heartbeats. Thread-safe.
  ///
  /// `fraction`  progress of the phase, 0..1; 0: unknown
  void prepare(const std::string& phase, double fraction);

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

  int percents_;  ///< between two lines
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
