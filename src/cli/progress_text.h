// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
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

/// The progress of a render.
struct ProgressState {
  std::uint64_t done = 0;   ///< samples
  std::uint64_t total = 1;  ///< samples
  double seconds = 0;       ///< since the start
  std::string goal = {};    ///< the target, as text; empty: the samples

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

}  // namespace orrery::cli
