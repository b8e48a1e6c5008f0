// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace orrery::points {

/// The values along a colour bar.
struct ValueScale {
  double first = 0, last = 1;  ///< finite, in any order
  bool is_log = false;         ///< equal steps are those of logarithms; both ends are above 0

  /// The position of a value: 0 at `first` to 1 at `last`; 0.5 if both are equal.
  double share_of(double value) const;
};

struct Tick {
  double value = 0;
  std::string label;
};

/// Returns ticks at multiples of 1, 2 or 5 times a power of ten in a range, with as many digits as distinguish them.
/// All labels are fixed ("0.25"), or, if the range reaches 1e6 or is below 1e-3, scientific with a common exponent
/// ("0.5e-7").
///
/// Domain     finite ends in any order
/// Result     4 to 11 ascending ticks; one if the ends are equal or too close to be distinguished; the ends if their
///            difference is not finite
std::vector<Tick> nice_ticks(double first, double last);

/// Returns the ticks of a scale: nice_ticks(), or on a logarithmic one of at least a decade powers of ten, with their
/// double and fivefold on less than three decades.
std::vector<Tick> ticks_of(const ValueScale& scale);

}  // namespace orrery::points
