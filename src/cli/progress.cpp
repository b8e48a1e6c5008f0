// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace orrery::cli {
namespace {

/// A supervisor that hears nothing for longer takes a render for hung.
constexpr double kHeartbeat = 60;  // seconds

std::string duration_text(double seconds) {
  char out[32];
  const auto s = static_cast<long>(std::ceil(std::min(seconds, 359999.0)));
  if (s >= 3600) {
    std::snprintf(out, sizeof(out), "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  } else {
    std::snprintf(out, sizeof(out), "%ld:%02ld", s / 60, s % 60);
  }
  return out;
}

std::string rate_text(double per_second) {
  char out[32];
  if (per_second >= 1e6) {
    std::snprintf(out, sizeof(out), "%.1f M samples/s", per_second / 1e6);
  } else {
    std::snprintf(out, sizeof(out), "%.0f k samples/s", per_second / 1e3);
  }
  return out;
}

}  // namespace

const std::vector<std::string>& progress_style_names() {
  static const std::vector<std::string> names = {"auto", "bar", "alf", "openjd", "arnold", "json", "none"};
  return names;
}

ProgressPrinter::ProgressPrinter(ProgressStyle style, std::FILE* to) : style_(style), to_(to) {
  if (style_ == ProgressStyle::kAuto) style_ = isatty(fileno(to_)) != 0 ? ProgressStyle::kBar : ProgressStyle::kArnold;
}

void ProgressPrinter::update(std::uint64_t done, std::uint64_t total, double seconds) {
  if (style_ == ProgressStyle::kNone || total == 0) return;
  const double fraction = static_cast<double>(done) / static_cast<double>(total);
  const double per_second = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  if (style_ == ProgressStyle::kBar) {
    const double left = done > 0 ? seconds / fraction - seconds : 0;
    print_bar(fraction, per_second, left);
    return;
  }
  const int percent = static_cast<int>(fraction * 100);
  if (percent == last_percent_ && seconds - last_line_s_ < kHeartbeat) return;
  last_percent_ = percent;
  last_line_s_ = seconds;
  print_line(percent, per_second);
}

void ProgressPrinter::print_bar(double fraction, double per_second, double seconds_left) {
  constexpr int kCells = 30;
  const int full = static_cast<int>(fraction * kCells);
  std::string bar(static_cast<std::size_t>(full), '#');
  bar.resize(kCells, '.');
  std::fprintf(to_, "\r[%s] %3d %%  %s  %s left \033[K", bar.c_str(), static_cast<int>(fraction * 100), rate_text(per_second).c_str(),
               duration_text(seconds_left).c_str());
  std::fflush(to_);
  bar_shown_ = true;
}

void ProgressPrinter::print_line(int percent, double per_second) {
  switch (style_) {
    case ProgressStyle::kAlf: std::fprintf(to_, "ALF_PROGRESS %d%%\n", percent); break;
    case ProgressStyle::kOpenJd: std::fprintf(to_, "openjd_progress: %d\n", percent); break;
    case ProgressStyle::kJson:
      std::fprintf(to_, "{\"progress\": %d, \"samples_per_second\": %.0f}\n", percent, per_second);
      break;
    case ProgressStyle::kArnold:
    case ProgressStyle::kAuto:
    case ProgressStyle::kBar:
    case ProgressStyle::kNone: std::fprintf(to_, "%d%% done\n", percent); break;
  }
  std::fflush(to_);
}

void ProgressPrinter::finish() {
  if (!bar_shown_) return;
  std::fputs("\r\033[K", to_);
  std::fflush(to_);
  bar_shown_ = false;
}

}  // namespace orrery::cli
