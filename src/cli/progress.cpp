// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "cli/messages.h"

namespace orrery::cli {
namespace {

/// Columns of the terminal; 80 if unknown.
int columns_of(std::FILE* terminal) {
  winsize size{};
  return ioctl(fileno(terminal), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

ProgressStyle resolved(ProgressStyle style, std::FILE* to) {
  if (style != ProgressStyle::kAuto) return style;
  return isatty(fileno(to)) != 0 ? ProgressStyle::kBar : ProgressStyle::kArnold;
}

}  // namespace

ProgressPrinter::ProgressPrinter(ProgressStyle style, std::FILE* to, std::chrono::milliseconds heartbeat)
    : style_(resolved(style, to)), to_(to), heartbeat_(heartbeat), state_{0, 1, 0} {
  if (style_ != ProgressStyle::kBar && style_ != ProgressStyle::kNone)
    printing_thread_ = std::thread([this] { print_periodically(); });
}

ProgressPrinter::~ProgressPrinter() { finish(); }

void ProgressPrinter::update(const ProgressState& state) {
  if (style_ == ProgressStyle::kNone) return;
  const std::lock_guard lock(mutex_);
  if (finished_) return;
  state_ = state;
  if (style_ == ProgressStyle::kBar) {
    print_bar(progress_bar(state_, columns_of(to_)));
  } else if (state_.percent() != last_percent_) {
    print_line();
  }
}

void ProgressPrinter::building(double fraction) {
  if (style_ != ProgressStyle::kBar) return;
  const std::lock_guard lock(mutex_);
  const int percent = static_cast<int>(fraction * 100);
  if (finished_ || state_.done > 0 || percent <= last_percent_) return;
  last_percent_ = percent;
  print_bar(fmt::format("building  {} %", percent));
}

void ProgressPrinter::note(const std::string& text) {
  const std::lock_guard lock(mutex_);
  clear_bar();
  print(printed_message(text));
  log_message(text);
}

void ProgressPrinter::finish() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
    clear_bar();
  }
  wake_.notify_all();
  if (printing_thread_.joinable()) printing_thread_.join();
}

void ProgressPrinter::print_bar(const std::string& bar) {
  bar_shown_ = true;
  std::fprintf(to_, "\r%s\033[K", bar.c_str());
  std::fflush(to_);
}

void ProgressPrinter::clear_bar() {
  if (!std::exchange(bar_shown_, false)) return;
  std::fputs("\r\033[K", to_);
  std::fflush(to_);
}

void ProgressPrinter::print(const std::string& lines) {
  std::fputs(lines.c_str(), to_);
  std::fflush(to_);
}

void ProgressPrinter::print_line() {
  const std::string line = progress_line(style_, state_) + "\n";
  print(line);
  log_message(line);
  last_percent_ = state_.percent();
  last_line_ = std::chrono::steady_clock::now();
}

/// Repeats the last line whenever a heartbeat has passed without one.
void ProgressPrinter::print_periodically() {
  std::unique_lock lock(mutex_);
  while (!finished_) {
    const auto due = last_line_ + heartbeat_;
    if (wake_.wait_until(lock, due, [this] { return finished_; })) return;
    if (std::chrono::steady_clock::now() >= last_line_ + heartbeat_) print_line();
  }
}

}  // namespace orrery::cli
