// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace orrery::cli {
namespace {

/// A bar of fewer cells says less than the percent beside it.
constexpr int kFewestCells = 8;
constexpr int kMostCells = 40;

std::string time_text(double seconds) {
  constexpr double kLongest = 359999;  // 99:59:59
  const auto s = static_cast<long>(std::ceil(std::min(seconds, kLongest)));
  char out[32];
  if (s >= 3600) {
    std::snprintf(out, sizeof(out), "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  } else {
    std::snprintf(out, sizeof(out), "%ld:%02ld", s / 60, s % 60);
  }
  return out;
}

std::string rate_text(double per_second) {
  char out[40];
  if (per_second >= 1e6) {
    std::snprintf(out, sizeof(out), "%.1f M samples/s", per_second / 1e6);
  } else if (per_second >= 1e3) {
    std::snprintf(out, sizeof(out), "%.1f k samples/s", per_second / 1e3);
  } else {
    std::snprintf(out, sizeof(out), "%.0f samples/s", per_second);
  }
  return out;
}

std::string json_line(const ProgressState& state) {
  char out[200];
  int length = std::snprintf(out, sizeof(out),
                             "{\"progress\": %d, \"samples_done\": %llu, \"samples_total\": %llu, \"seconds\": %.1f",
                             state.percent(), static_cast<unsigned long long>(state.done),
                             static_cast<unsigned long long>(state.total), state.seconds);
  std::string line(out, static_cast<std::size_t>(length));
  if (state.seconds_left() >= 0) {
    length = std::snprintf(out, sizeof(out), ", \"samples_per_second\": %.0f, \"seconds_left\": %.1f",
                           state.samples_per_second(), state.seconds_left());
    line.append(out, static_cast<std::size_t>(length));
  }
  if (!state.goal.empty()) line += ", \"goal\": \"" + state.goal + "\"";
  return line + "}";
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
  const std::string percent = std::to_string(state.percent());
  switch (style) {
    case ProgressStyle::kAlf: return "ALF_PROGRESS " + percent + "%";
    case ProgressStyle::kOpenJd: return "openjd_progress: " + percent;
    case ProgressStyle::kJson: return json_line(state);
    case ProgressStyle::kArnold:
    case ProgressStyle::kAuto:
    case ProgressStyle::kBar:
    case ProgressStyle::kNone: break;
  }
  return percent + "% done";
}

std::string progress_bar(const ProgressState& state, int columns) {
  char percent[8];
  std::snprintf(percent, sizeof(percent), "%3d %%", state.percent());
  std::string text = std::string(percent) + "  " + rate_text(state.samples_per_second());
  if (state.seconds_left() >= 0) text += "  " + time_text(state.seconds_left()) + " left";
  if (!state.goal.empty()) text += "  " + state.goal;
  // Brackets, a space, and the last column, in which some terminals begin a new line.
  const int cells = std::min(kMostCells, columns - static_cast<int>(text.size()) - 4);
  if (cells < kFewestCells) return text.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
  std::string bar(static_cast<std::size_t>(state.fraction() * cells), '#');
  bar.resize(static_cast<std::size_t>(cells), '.');
  return "[" + bar + "] " + text;
}

}  // namespace orrery::cli
