// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::measure {

/// The middle half of some measurements.
struct Quartiles {
  double low = 0, median = 0, high = 0;
};

/// Linear between the two nearest values.
///
/// Domain     one value or more
Quartiles quartiles(std::vector<double> values);

}  // namespace orrery::measure
