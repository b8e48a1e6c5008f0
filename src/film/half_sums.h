// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "kernel/guide_sum.h"
#include "kernel/pixel_sum.h"

namespace orrery::film {

/// Sums over half of a pixel's paths.
struct HalfSums {
  kernel::PixelSum light;
  kernel::GuideSum guides;

  HalfSums& operator+=(const HalfSums& other) noexcept {
    light += other.light;
    guides += other.guides;
    return *this;
  }
};

/// Both halves of a pixel.
using Halves = std::array<HalfSums, 2>;

}  // namespace orrery::film
