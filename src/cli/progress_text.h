// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace orrery::cli {

/// In whose words a render tells how far it is.
enum class ProgressStyle {
  kAuto,    ///< the bar on a terminal, kArnold elsewhere
  kBar,     ///< one line that is written over and over
  kAlf,     ///< "ALF_PROGRESS 42%": Tractor
  kOpenJd,  ///< "openjd_progress: 42": Open Job Description, Deadline Cloud
  kArnold,  ///< "42% done": what farm managers find in the log of many renderers
  kJson,    ///< one JSON object a line
  kNone,
};

/// Names of the styles, in the order of the enumerators.
const std::vector<std::string>& progress_style_names();

/// The style of a name.
///
/// Domain     one of progress_style_names()
ProgressStyle progress_style(const std::string& name);

/// How far a render is.
struct ProgressState {
  std::uint64_t done = 0;   ///< samples
  std::uint64_t total = 1;  ///< samples
  double seconds = 0;       ///< since it began
  std::string goal = {};    ///< what ends it, in words; empty: its samples

  double fraction() const;            ///< 0..1
  int percent() const;                ///< whole, rounded down: 100 only when all is done
  double samples_per_second() const;  ///< 0 while unknown
  double seconds_left() const;        ///< by the mean rate so far; negative while unknown
};

/// One line for a log or a farm manager, without its end.
///
/// Domain     a style that has lines: kAlf, kOpenJd, kArnold or kJson
std::string progress_line(ProgressStyle style, const ProgressState& state);

/// "[#####.....]  42 %  2.3 M samples/s  1:05 left", cut to the columns of the terminal.
std::string progress_bar(const ProgressState& state, int columns);

}  // namespace orrery::cli
