// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// Rays that are traced together; one 512-bit register of floats holds one component of all of them.
inline constexpr int kPacketSize = 16;

/// Up to sixteen rays, component by component, and what they hit.
///
/// A ray that leaves a sphere starts at its centre plus `offset`; the sum stands in `origin`, and what its rounding
/// lost in `origin_low`. So a sphere far from the world's origin loses nothing, and the sphere that is left can be
/// told apart from all others (`self`), which is what makes an epsilon unnecessary.
///
/// T is double (exact, book) or float (fast); ids are as wide as T so that masks fit both.
template <class T, class Id>
struct alignas(64) RayPacketOf {
  T origin[3][kPacketSize];
  T origin_low[3][kPacketSize];
  T offset[3][kPacketSize];
  T direction[3][kPacketSize];    ///< any length that is not zero; unit within the renderer
  T inverse_square[kPacketSize];  ///< 1 / (direction . direction)
  Id self[kPacketSize];           ///< sphere that the ray leaves, or kNoSphere
  T distance[kPacketSize];        ///< in: farther hits do not count; out: of the nearest hit, in lengths of direction
  Id hit[kPacketSize];            ///< in: kNoSphere; out: the sphere of the nearest hit, or kNoSphere
  T time[kPacketSize];            ///< 0..1 within the shutter; only where the scene moves
  int count = 0;                  ///< rays in use, the first ones
};

using RayPacket = RayPacketOf<double, std::uint64_t>;
using RayPacketFast = RayPacketOf<float, std::uint32_t>;

/// How the kernel finds the nearest hit of a packet: whatever stands behind `self` fills distance and hit.
///
/// Hits do not depend on how they were found: the nearest distance wins, then the smaller id.
struct Tracer {
  void (*trace)(const void* self, RayPacket& packet) = nullptr;
  void (*trace_fast)(const void* self, RayPacketFast& packet) = nullptr;
  const void* self = nullptr;
  std::int64_t target = 0;  ///< instruction set that it was compiled for, HWY_AVX2 etc.; 0: nothing of ours
};

inline void trace(const Tracer& tracer, RayPacket& packet) { tracer.trace(tracer.self, packet); }
inline void trace(const Tracer& tracer, RayPacketFast& packet) { tracer.trace_fast(tracer.self, packet); }

/// Nothing is hit yet, at any distance.
template <class T, class Id>
inline void reset_hits(RayPacketOf<T, Id>& packet) {
  std::fill_n(packet.distance, kPacketSize, std::numeric_limits<T>::max());
  std::fill_n(packet.hit, kPacketSize, Id{kNoSphere});
}

}  // namespace orrery::kernel
