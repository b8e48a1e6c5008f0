// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "kernel/pixel_sum.h"
#include "kernel/sphere.h"
#include "math/pixels.h"

namespace orrery::kernel {

/// An emitter as the camera sees it: directly, or in a ball.
struct Sight {
  std::uint32_t ball = kCamera;  ///< sphere that reflects it; kCamera: none
  std::uint32_t emitter = 0;     ///< a sphere, or kSun

  std::uint64_t key() const noexcept { return std::uint64_t{ball} << 32 | emitter; }
};

/// An emitter of a pixel.
struct SeenEmitter {
  std::uint32_t id = 0;  ///< of a sphere, or kSun
  float share_end = 0;   ///< probability of being chosen, plus those of the pixel's emitters before it; 1: the last
  bool by_lens = false;  ///< for a point of the film, a point of the lens is sampled; otherwise vice versa
  std::uint32_t ball = kCamera;  ///< as in Sight

  std::uint64_t key() const noexcept { return Sight{ball, id}.key(); }
};

/// Small or blurred emitters that the camera sees, and small images of emitters in balls: for each pixel, those that
/// are sampled, by ascending key. A camera ray of the pixel that hits one of them, or that such a ball reflects to it,
/// gains nothing from it.
///
/// Reference  docs/decisions/0046
struct SeenEmitters {
  const std::uint32_t* begins = nullptr;  ///< of each pixel of the window, and the end; null: there are none
  const SeenEmitter* emitters = nullptr;
  int width = 0;                  ///< px, of the window
  std::span<const Sight> sights;  ///< all that are sampled, by ascending key

  bool has(Sight sight) const noexcept { return std::ranges::binary_search(sights, sight.key(), {}, &Sight::key); }
  std::span<const SeenEmitter> at(PixelPlace place) const noexcept {
    const std::uint32_t* const begin = begins + math::pixel_index(place.x, place.y, width);
    return {emitters + begin[0], emitters + begin[1]};
  }
  bool has(PixelPlace place, Sight sight) const noexcept {
    return std::ranges::binary_search(at(place), sight.key(), {}, &SeenEmitter::key);
  }
};

}  // namespace orrery::kernel
