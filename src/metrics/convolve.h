// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// A kernel of 2 * radius + 1 taps along one axis.
using Taps = std::vector<float>;

/// `shape` at -radius .. radius, scaled so that all add up to 1.
Taps taps_of(int radius, const std::function<double(double)>& shape);

/// exp(-x^2 / (2 sigma^2)), adding up to 1.
Taps gaussian_taps(int radius, double sigma);

/// A map filtered by the product of two kernels; beyond the edge its outermost value goes on.
Map convolved(const Map& map, const Taps& along_x, const Taps& along_y);

}  // namespace orrery::metrics
