// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernel/pixel_sum.h"
#include "math/pixels.h"

namespace orrery::kernel {

/// An emitter of a pixel.
struct SeenEmitter {
  std::uint32_t id = 0;  ///< of a sphere
  float share_end = 0;   ///< probability of being chosen, plus those of the pixel's emitters before it; 1: the last
  bool by_lens = false;  ///< for a point of the film, a point of the lens is sampled; otherwise vice versa
};

/// Small or blurred emitters that the camera sees: for each pixel, those that are sampled, by ascending id. A camera
/// ray of the pixel that hits one of them gains nothing.
///
/// Reference  docs/decisions/0046
struct SeenEmitters {
  const std::uint32_t* begins = nullptr;  ///< of each pixel of the window, and the end; null: there are none
  const SeenEmitter* emitters = nullptr;
  int width = 0;                       ///< px, of the window
  std::span<const std::uint32_t> ids;  ///< of all emitters that are sampled, ascending

  bool has(std::uint32_t id) const noexcept { return std::ranges::binary_search(ids, id); }
  std::span<const SeenEmitter> at(PixelPlace place) const noexcept {
    const std::uint32_t* const begin = begins + math::pixel_index(place.x, place.y, width);
    return {emitters + begin[0], emitters + begin[1]};
  }
  bool has(PixelPlace place, std::uint64_t id) const noexcept {
    const auto all = at(place);
    return std::ranges::binary_search(all, id, {}, [](const SeenEmitter& e) { return std::uint64_t{e.id}; });
  }
};

}  // namespace orrery::kernel
