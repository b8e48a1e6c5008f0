// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// A rod in the kernel's layout: all points within `radius` of the segment from a to b, in one cache line.
///
/// Rods are opaque. `compile` orders the ends, since exchanging them changes rounding.
struct alignas(64) Rod {
  double a[3] = {0, 0, 0};  ///< scene units
  double radius = 1;        ///< scene units, > 0
  double b[3] = {0, 0, 0};  ///< scene units; may equal a: the rod is then a sphere
  double unused = 0;        ///< a row is gathered as twice four doubles
};

/// A rod between the centres of two spheres, with which its ends move.
struct Bond {
  std::uint32_t a = 0, b = 0;  ///< spheres whose centres are the ends, which are in order as those of a Rod
  std::uint32_t radius = 0;    ///< index into RodArray::bond_radii
};

/// Non-owning view of the rods of a scene: those stored in full, then bonds.
///
/// A rod has two ids, one for each half: those of rod i are `first_id + 2 i` on the half at a, and the next one on the
/// half at b. Ids of rods follow those of spheres, so that a sphere wins a tie with a rod: a ray that leaves a rod
/// through its end would otherwise hit a coincident sphere from inside.
struct RodArray {
  const Rod* plain = nullptr;
  std::size_t count = 0;        ///< with bonds
  const Rod* motion = nullptr;  ///< change of the first `moving_count` rods in `plain` until the shutter closes
  std::size_t moving_count = 0;
  std::size_t first_id = 0;  ///< the number of spheres
  const Bond* bonds = nullptr;
  std::size_t bond_count = 0;
  const double* bond_radii = nullptr;
  SphereArray spheres = {};  ///< those that bonds refer to
  /// Motion of the first `moving_spheres` of them, as in SceneView, if bonds move.
  const Sphere* sphere_motion = nullptr;
  std::size_t moving_spheres = 0;

  std::size_t plain_count() const noexcept { return count - bond_count; }
  const Bond& bond(std::size_t rod) const noexcept { return bonds[rod - plain_count()]; }

  /// A rod when the shutter opens.
  Rod operator[](std::size_t rod) const noexcept {
    if (rod < plain_count()) return plain[rod];
    const Bond& of = bond(rod);
    const Sphere a = spheres[of.a], b = spheres[of.b];
    return {{a.x, a.y, a.z}, bond_radii[of.radius], {b.x, b.y, b.z}, 0};
  }

  bool any_moves() const noexcept { return moving_count > 0 || moving_spheres > 0; }
  bool moves(std::size_t rod) const noexcept {
    if (rod < plain_count()) return rod < moving_count;
    return moving_spheres > 0 && (bond(rod).a < moving_spheres || bond(rod).b < moving_spheres);
  }
  /// The change of a rod until the shutter closes.
  Rod change(std::size_t rod) const noexcept {
    constexpr Rod kAtRest{{0, 0, 0}, 0, {0, 0, 0}, 0};
    if (!moves(rod)) return kAtRest;
    if (rod < plain_count()) return motion[rod];
    constexpr Sphere kResting{0, 0, 0, 0};
    const Bond& of = bond(rod);
    const Sphere &a = of.a < moving_spheres ? sphere_motion[of.a] : kResting,
                 &b = of.b < moving_spheres ? sphere_motion[of.b] : kResting;
    return {{a.x, a.y, a.z}, 0, {b.x, b.y, b.z}, 0};
  }

  /// The address of a rod's data, for prefetching.
  const void* address(std::size_t rod) const noexcept {
    return rod < plain_count() ? static_cast<const void*>(plain + rod) : &bond(rod);
  }

  bool empty() const noexcept { return count == 0; }
  /// Whether the id of a hit is that of a rod.
  bool contains(std::size_t id) const noexcept { return id >= first_id && id - first_id < 2 * count; }
  std::size_t index(std::size_t id) const noexcept { return (id - first_id) / 2; }
  std::uint32_t id(std::size_t rod) const noexcept { return static_cast<std::uint32_t>(first_id + 2 * rod); }

  /// The number of a hit's object: rods follow the spheres.
  std::size_t object(std::size_t id) const noexcept { return contains(id) ? first_id + index(id) : id; }

  /// A rod at a time between 0 (shutter opens) and 1 (shutter closes), computed like in the kernel's loops.
  Rod at(std::size_t rod, double time) const noexcept {
    Rod out = (*this)[rod];
    if (!moves(rod)) return out;
    const Rod by = change(rod);
    for (int k = 0; k < 3; ++k) {
      out.a[k] = std::fma(by.a[k], time, out.a[k]);
      out.b[k] = std::fma(by.b[k], time, out.b[k]);
    }
    out.radius = std::fma(by.radius, time, out.radius);
    return out;
  }
};

}  // namespace orrery::kernel
