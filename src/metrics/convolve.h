// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "metrics/color_view.h"

namespace orrery::metrics {

/// A one-dimensional kernel of 2 * radius + 1 taps.
using Taps = std::vector<float>;

/// Samples `shape` at -radius .. radius and normalizes the taps to a sum of 1.
Taps taps_of(int radius, const std::function<double(double)>& shape);

/// A Gaussian kernel, normalized to a sum of 1.
///
/// Units      `radius` and `sigma` in pixels
Taps gaussian_taps(int radius, double sigma);

/// Convolves a map with a separable kernel. The edge pixels are extended beyond the border.
Map convolved(const Map& map, const Taps& along_x, const Taps& along_y);

}  // namespace orrery::metrics
