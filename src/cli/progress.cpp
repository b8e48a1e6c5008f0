// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "cli/messages.h"

namespace orrery::cli {
namespace {

/// Limits of the bar's length. A shorter bar would be coarser than the percentage.
constexpr int kMinCells = 8;
constexpr int kMaxCells = 40;

std::string time_text(double seconds) {
  constexpr double kLongest = 359999;  // 99:59:59
  const auto s = static_cast<long>(std::ceil(std::min(seconds, kLongest)));
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string rate_text(double per_second) {
  if (per_second >= 1e6) return fmt::format("{:.1f} M samples/s", per_second / 1e6);
  if (per_second >= 1e3) return fmt::format("{:.1f} k samples/s", per_second / 1e3);
  return fmt::format("{:.0f} samples/s", per_second);
}

std::string json_line(const ProgressState& state) {
  std::string line = fmt::format("{{\"progress\": {}, \"samples_done\": {}, \"samples_total\": {}, \"seconds\": {:.1f}",
                                 state.percent(), state.done, state.total, state.seconds);
  if (state.seconds_left() >= 0)
    line += fmt::format(", \"samples_per_second\": {:.0f}, \"seconds_left\": {:.1f}", state.samples_per_second(),
                        state.seconds_left());
  if (!state.goal.empty()) line += fmt::format(", \"goal\": \"{}\"", state.goal);
  if (!state.phase.empty()) line += fmt::format(", \"phase\": \"{}\"", state.phase);
  if (state.prepared > 0) line += fmt::format(", \"phase_progress\": {}", static_cast<int>(state.prepared * 100));
  return line + "}";
}

/// "building  10 %". The space keeps programs that look for "10%" from reading it.
std::string phase_text(const ProgressState& state) {
  return state.prepared > 0 ? fmt::format("{}  {} %", state.phase, static_cast<int>(state.prepared * 100))
                            : state.phase;
}

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

const std::vector<std::string>& progress_style_names() {
  static const std::vector<std::string> names = {"auto", "bar", "alf", "openjd", "arnold", "json", "none"};
  return names;
}

ProgressStyle progress_style(const std::string& name) {
  const auto& names = progress_style_names();
  return static_cast<ProgressStyle>(std::find(names.begin(), names.end(), name) - names.begin());
}

double ProgressState::fraction() const {
  return total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

int ProgressState::percent() const { return done >= total ? 100 : std::min(99, static_cast<int>(fraction() * 100)); }

double ProgressState::samples_per_second() const { return seconds > 0 ? static_cast<double>(done) / seconds : 0; }

double ProgressState::seconds_left() const {
  return samples_per_second() > 0 ? seconds * (1 - fraction()) / fraction() : -1;
}

std::string progress_line(ProgressStyle style, const ProgressState& state) {
  switch (style) {
    case ProgressStyle::kAlf: return fmt::format("ALF_PROGRESS {}%", state.percent());
    case ProgressStyle::kOpenJd: return fmt::format("openjd_progress: {}", state.percent());
    case ProgressStyle::kJson: return json_line(state);
    case ProgressStyle::kArnold:
    case ProgressStyle::kAuto:
    case ProgressStyle::kBar:
    case ProgressStyle::kNone: break;
  }
  return fmt::format("{}% done", state.percent()) + (state.phase.empty() ? "" : ", " + phase_text(state));
}

std::string progress_bar(const ProgressState& state, int columns) {
  std::string text = fmt::format("{:3} %", state.percent());
  if (state.samples_per_second() > 0) text += "  " + rate_text(state.samples_per_second());
  if (state.seconds_left() >= 0) text += fmt::format("  {} left", time_text(state.seconds_left()));
  if (!state.goal.empty()) text += "  " + state.goal;
  // Leaves room for brackets, a space, and the last column, after which some terminals wrap.
  const int cells = std::min(kMaxCells, columns - static_cast<int>(text.size()) - 4);
  if (cells < kMinCells) return text.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
  std::string bar(static_cast<std::size_t>(state.fraction() * cells), '#');
  bar.resize(static_cast<std::size_t>(cells), '.');
  return fmt::format("[{}] {}", bar, text);
}

ProgressPrinter::ProgressPrinter(ProgressStyle style, std::FILE* to, std::chrono::milliseconds heartbeat)
    : percents_(style == ProgressStyle::kAuto ? 10 : 1),
      style_(resolved(style, to)),
      to_(to),
      heartbeat_(heartbeat),
      state_{0, 1, 0} {
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
  } else if (state_.percent() / percents_ != last_percent_ / percents_) {
    print_line();
  }
}

void ProgressPrinter::prepare(const std::string& phase, double fraction) {
  const std::lock_guard lock(mutex_);
  if (finished_ || state_.done > 0 || (phase == state_.phase && fraction <= state_.prepared)) return;
  const std::string before = phase_text(state_);
  state_.phase = phase;
  state_.prepared = fraction;
  if (style_ == ProgressStyle::kBar && phase_text(state_) != before) print_bar(phase_text(state_));
}

void ProgressPrinter::note(const std::string& text) {
  const std::lock_guard lock(mutex_);
  clear_bar();
  print(printed_message(text));
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
  print(progress_line(style_, state_) + "\n");
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
