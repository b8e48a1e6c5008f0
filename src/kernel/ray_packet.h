// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// Rays per packet: the number of floats in a 512-bit register.
inline constexpr int kPacketSize = 16;

/// Up to sixteen rays in structure-of-arrays form.
///
/// A ray that leaves a sphere starts at the sphere's centre plus `offset`. `origin` holds the rounded sum and
/// `origin_low` its rounding error, so a sphere far from the world origin loses no precision. `self` identifies the
/// sphere that the ray leaves, which makes an epsilon unnecessary.
///
/// T is double (exact, book) or float (fast); ids are as wide as T so that masks fit both.
template <class T, class Id>
struct alignas(64) RaysOf {
  T origin[3][kPacketSize];
  T origin_low[3][kPacketSize];
  T offset[3][kPacketSize];
  T direction[3][kPacketSize];
  T inverse_square[kPacketSize];  ///< 1 / (direction . direction)
  Id self[kPacketSize];           ///< sphere that the ray leaves, or kNoSphere
  T distance[kPacketSize];        ///< maximum distance of a hit, as a multiple of the direction's length
  T time[kPacketSize];            ///< 0..1 within the shutter; only if the scene moves
  int count = 0;                  ///< number of rays in use, from the first
};

/// Rays and their closest hits. Directions are unit; `distance` becomes that of the closest hit.
template <class T, class Id>
struct RayPacketOf : RaysOf<T, Id> {
  alignas(64) Id hit[kPacketSize];  ///< in: kNoSphere; out: the sphere of the closest hit, or kNoSphere
};

/// Rays and whether they are occluded. Directions may have any length whose square and its reciprocal are finite.
template <class T, class Id>
struct ShadowPacketOf : RaysOf<T, Id> {
  alignas(64) Id target[kPacketSize];  ///< sphere that does not occlude: the light that the ray goes to, or kNoSphere
  Id occluded[kPacketSize];            ///< out: all bits set if a sphere is hit in 0 < t < distance, else 0
};

using RayPacket = RayPacketOf<double, std::uint64_t>;
using RayPacketFast = RayPacketOf<float, std::uint32_t>;
using ShadowPacket = ShadowPacketOf<double, std::uint64_t>;
using ShadowPacketFast = ShadowPacketOf<float, std::uint32_t>;

/// How the kernel queries the scene. Neither query's results depend on the order of traversal: of two closest hits the
/// smaller distance wins, then the smaller id, and occlusion is an OR over all spheres.
struct Tracer {
  void (*trace)(const void* self, RayPacket& packet) = nullptr;
  void (*trace_fast)(const void* self, RayPacketFast& packet) = nullptr;
  void (*occlude)(const void* self, ShadowPacket& packet) = nullptr;
  void (*occlude_fast)(const void* self, ShadowPacketFast& packet) = nullptr;
  const void* self = nullptr;
  std::int64_t target = 0;  ///< instruction set that the functions were compiled for, HWY_AVX2 etc.; 0: unknown
};

/// Finds the closest hits of a packet.
inline void trace(const Tracer& tracer, RayPacket& packet) { tracer.trace(tracer.self, packet); }
inline void trace(const Tracer& tracer, RayPacketFast& packet) { tracer.trace_fast(tracer.self, packet); }

/// Determines which rays of a packet are occluded.
inline void occlude(const Tracer& tracer, ShadowPacket& packet) { tracer.occlude(tracer.self, packet); }
inline void occlude(const Tracer& tracer, ShadowPacketFast& packet) { tracer.occlude_fast(tracer.self, packet); }

/// Resets all rays of a packet to no hit, with an unlimited maximum distance.
template <class T, class Id>
inline void reset_hits(RayPacketOf<T, Id>& packet) {
  std::fill_n(packet.distance, kPacketSize, std::numeric_limits<T>::max());
  std::fill_n(packet.hit, kPacketSize, Id{kNoSphere});
}

}  // namespace orrery::kernel
