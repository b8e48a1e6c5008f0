// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metrics/color_view.h"

namespace orrery::metrics {

/// The mean structural similarity of the luma of two pictures of codes 0..1; 1: the same.
///
/// Domain     views of the same size, with channels
/// Reference  wang2004: windows of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03; beyond edges the outermost values go on
double ssim(const ColorView& picture, const ColorView& reference);

}  // namespace orrery::metrics
