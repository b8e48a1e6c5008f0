// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace orrery::kernel {

/// A sphere in the kernel's layout: four doubles, half a cache line.
///
/// The radius is positive: `compile` turns an authored negative radius into a material with its sides swapped.
struct alignas(32) Sphere {
  double x = 0, y = 0, z = 0;  ///< centre, scene units
  double radius = 1;           ///< scene units, > 0
};

// Ids of objects: first the spheres, then two for each rod, its halves. What has no id has one of these names:
inline constexpr std::uint32_t kNone = 0xffffffffu;  ///< no object, no texture: rays that hit nothing
inline constexpr std::uint32_t kCamera = kNone;      ///< what camera rays leave
inline constexpr std::uint32_t kSun = kNone;         ///< as a light: rays that hit nothing reach it

/// Non-owning view of unsigned integers of 0, 1, 2 or 4 bytes each.
///
/// Reading an element loads four bytes from its start, so three bytes after the last element must be readable.
struct IndexArray {
  const unsigned char* data = nullptr;
  std::uint32_t stride = 0;  ///< bytes; 0: all are equal, and stored in four bytes
  std::uint32_t mask = 0;    ///< mask of the bits that belong to an element

  IndexArray() = default;
  IndexArray(const unsigned char* bytes, std::uint32_t bytes_each)
      : data(bytes), stride(bytes_each), mask(bytes_each % 4 == 0 ? 0xffffffffu : (1u << 8 * bytes_each) - 1) {}
  IndexArray(const std::uint32_t* elements)  // NOLINT(google-explicit-constructor): implicit view of an array
      : IndexArray(reinterpret_cast<const unsigned char*>(elements), sizeof(std::uint32_t)) {}

  std::uint32_t operator[](std::size_t i) const noexcept {
    std::uint32_t element = 0;
    std::memcpy(&element, data + i * stride, sizeof(element));
    return element & mask;
  }
};

/// Non-owning view of the spheres of a scene.
///
/// The first spheres are stored in full. The others may be compact if that is lossless: centres in single precision,
/// and a single radius for all, one per sphere, or one per sphere from a palette. The kernel reads each centre as a
/// vector of four floats.
struct SphereArray {
  const Sphere* plain = nullptr;
  std::size_t plain_count = std::numeric_limits<std::size_t>::max();  ///< number of spheres in `plain`, the first ones
  const float* centers = nullptr;                ///< x, y, z of the others; one more float is readable
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

  /// One coordinate of a centre.
  ///
  /// `axis`     0, 1 or 2
  double coordinate(std::size_t id, int axis) const noexcept {
    if (id >= plain_count) return static_cast<double>(centers[3 * (id - plain_count) + static_cast<std::size_t>(axis)]);
    return axis == 0 ? plain[id].x : axis == 1 ? plain[id].y : plain[id].z;
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
