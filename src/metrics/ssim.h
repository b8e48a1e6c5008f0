// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metrics/color_view.h"

namespace orrery::metrics {

/// The mean structural similarity (SSIM) of the luma of two display-encoded images.
///
/// Domain     values 0..1; views of the same size, with channels
/// Result     1 for identical images
/// Reference  wang2004: 11 x 11 Gaussian window, sigma 1.5, K1 = 0.01, K2 = 0.03; edge pixels extended past the border
double ssim(const ColorView& picture, const ColorView& reference);

}  // namespace orrery::metrics
