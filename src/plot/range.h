// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::plot {

/// How the range of a colour map is chosen: numbers or percentiles of the values.
struct RangeChoice {
  struct End {
    double value;
    bool is_percentile;
  };

  End low{0, true}, high{100, true};
  bool is_symmetric = false;  ///< -m to m, where m is the larger magnitude of the ends
  bool is_log = false;
  bool is_set = false;  ///< by the user

  /// The range, if it does not depend on the values.
  std::optional<scene::Interval> fixed() const;
};

/// Rounds a number to significant digits.
double rounded(double x, int digits = 4);

/// "LOW:HIGH", with as many digits as distinguish a thousandth of the range, at least four.
std::string range_text(const scene::Interval& range);

/// Parses words separated by commas: `log`, `symmetric` and `LOW:HIGH`, with numbers or percentiles: "log,1%:99%".
///
/// Errors     base::Error(kUsage)
RangeChoice parse_range(const std::string& text);

/// Determines a range from values.
class RangeFinder {
 public:
  explicit RangeFinder(const RangeChoice& choice);

  void add(double value);
  bool is_empty() const { return count_ == 0; }
  /// Returns the range of the values so far. Percentiles other than 0 and 100 are those of a regular sample, if there
  /// are more than 16 million values.
  ///
  /// Domain     not empty
  /// Errors     base::Error(kBadData) if the lower end is above the upper one
  scene::Interval range();
  /// An interval of at most a tenth of the minimum to the maximum that has 99 % of the values: a few others would use
  /// up the colour map. None unless the range is that of all values.
  std::optional<scene::Interval> crowded();

 private:
  double end(const RangeChoice::End& end);

  RangeChoice choice_;
  bool needs_values_;
  std::size_t count_ = 0;
  std::size_t stride_ = 1;      ///< every `stride_`-th value is kept
  std::vector<double> values_;  ///< a regular sample
  scene::Interval extremes_;
};

}  // namespace orrery::plot
