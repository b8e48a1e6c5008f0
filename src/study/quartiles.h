// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace orrery::study {

/// Lower quartile, median and upper quartile.
struct Quartiles {
  double low = 0, median = 0, high = 0;
};

/// The quartiles of measurements, linearly interpolated between the two nearest values.
///
/// Domain     at least one value
Quartiles quartiles(std::vector<double> values);

}  // namespace orrery::study
