// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace orrery::cli {

/// In which words a render tells how far it is.
enum class ProgressStyle { kAuto, kBar, kAlf, kOpenJd, kArnold, kJson, kNone };
const std::vector<std::string>& progress_style_names();  ///< in the order of the enumerators

/// Tells how far a render is: one line with a bar on a terminal, otherwise a line whenever the whole percent changes,
/// and at least every minute.
class ProgressPrinter {
 public:
  ProgressPrinter(ProgressStyle style, std::FILE* to);
  ~ProgressPrinter() { finish(); }
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void update(std::uint64_t done, std::uint64_t total, double seconds);

  /// Takes the bar away, so that the next message has its line.
  void finish();

 private:
  void print_bar(double fraction, double per_second, double seconds_left);
  void print_line(int percent, double per_second);

  ProgressStyle style_;
  std::FILE* to_;
  int last_percent_ = -1;
  double last_line_s_ = 0;
  bool bar_shown_ = false;
};

}  // namespace orrery::cli
