// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace orrery::points {

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

}  // namespace orrery::points
