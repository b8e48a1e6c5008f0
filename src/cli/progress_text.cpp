// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

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
  switch (style) {
    case ProgressStyle::kAlf: return fmt::format("ALF_PROGRESS {}%", state.percent());
    case ProgressStyle::kOpenJd: return fmt::format("openjd_progress: {}", state.percent());
    case ProgressStyle::kJson: return json_line(state);
    case ProgressStyle::kArnold:
    case ProgressStyle::kAuto:
    case ProgressStyle::kBar:
    case ProgressStyle::kNone: break;
  }
  return fmt::format("{}% done", state.percent());
}

std::string progress_bar(const ProgressState& state, int columns) {
  std::string text = fmt::format("{:3} %  {}", state.percent(), rate_text(state.samples_per_second()));
  if (state.seconds_left() >= 0) text += fmt::format("  {} left", time_text(state.seconds_left()));
  if (!state.goal.empty()) text += "  " + state.goal;
  // Leaves room for brackets, a space, and the last column, after which some terminals wrap.
  const int cells = std::min(kMaxCells, columns - static_cast<int>(text.size()) - 4);
  if (cells < kMinCells) return text.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
  std::string bar(static_cast<std::size_t>(state.fraction() * cells), '#');
  bar.resize(static_cast<std::size_t>(cells), '.');
  return fmt::format("[{}] {}", bar, text);
}

}  // namespace orrery::cli
