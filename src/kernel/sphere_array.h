// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// Non-owning view of the spheres of a scene.
///
/// The first spheres are stored in full. The others may be compact if that is lossless: centres in single precision,
/// and a single radius for all, one per sphere, or one per sphere from a palette. The kernel reads each centre as a
/// vector of four floats.
struct SphereArray {
  const Sphere* plain = nullptr;
  std::size_t plain_count = std::numeric_limits<std::size_t>::max();  ///< number of spheres in `plain`, the first ones
  const float* centers = nullptr;                ///< x, y, z of the others, plus one element of padding
  const float* radii = nullptr;                  ///< radii of the others; null: from the palette
  const std::uint8_t* radius_indices = nullptr;  ///< palette indices of the others; null: the first radius for all
  const double* radius_palette = nullptr;

  SphereArray() = default;
  SphereArray(const Sphere* spheres)
      : plain(spheres) {}  // NOLINT(google-explicit-constructor): implicit view of an array

  Sphere operator[](std::size_t id) const noexcept {
    if (id < plain_count) return plain[id];
    const std::size_t i = id - plain_count;
    return {static_cast<double>(centers[3 * i]), static_cast<double>(centers[3 * i + 1]),
            static_cast<double>(centers[3 * i + 2]), radius_of_compact(i)};
  }

  /// The radius of a compact sphere.
  double radius_of_compact(std::size_t i) const noexcept {
    return radii != nullptr ? static_cast<double>(radii[i])
                            : radius_palette[radius_indices != nullptr ? radius_indices[i] : 0];
  }

  /// The address of a sphere's centre, for prefetching.
  const void* address(std::size_t id) const noexcept {
    return id < plain_count ? static_cast<const void*>(plain + id)
                            : static_cast<const void*>(centers + 3 * (id - plain_count));
  }

  bool all_plain() const noexcept { return centers == nullptr; }
};

}  // namespace orrery::kernel
