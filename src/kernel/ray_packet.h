// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// Rays per packet: the number of floats in a 512-bit register.
inline constexpr int kPacketSize = 16;

/// Most packets of a query. While a ray waits for memory, the others go on.
inline constexpr int kPacketsInFlight = 4;

/// Unsigned integers for ids, as wide as T so that masks fit both.
template <class T>
using IdOf = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

/// Up to sixteen rays in structure-of-arrays form. T is double (exact, book) or float (fast).
///
/// A ray that leaves a sphere starts at the sphere's centre plus `offset`. `origin` holds the rounded sum and
/// `origin_low` its rounding error, so a sphere far from the world origin loses no precision. `self` identifies the
/// object that the ray leaves, which makes an epsilon unnecessary.
template <class T>
struct alignas(64) PacketRays {
  using Number = T;
  using Id = IdOf<T>;
  T origin[3][kPacketSize];
  T origin_low[3][kPacketSize];
  T offset[3][kPacketSize];
  T direction[3][kPacketSize];
  T inverse_square[kPacketSize];  ///< 1 / (direction . direction)
  Id self[kPacketSize];           ///< object that the ray leaves, or kCamera
  T distance[kPacketSize];        ///< maximum distance of a hit, as a multiple of the direction's length
  T time[kPacketSize];            ///< 0..1 within the shutter; only if the scene moves
  float threshold[kPacketSize];   ///< 0..1: objects with a greater opacity are visible; only if the scene has opacities
  int count = 0;                  ///< number of rays in use, from the first
};

/// Rays and their closest hits. Directions are unit; `distance` becomes that of the closest hit.
template <class T>
struct RayPacket : PacketRays<T> {
  static constexpr bool kIsShadow = false;
  alignas(64) IdOf<T> hit[kPacketSize];  ///< in: kNone; out: the object of the closest hit, or kNone
};

/// Rays and whether they are occluded. Directions may have any length whose square and its reciprocal are finite.
template <class T>
struct ShadowPacket : PacketRays<T> {
  static constexpr bool kIsShadow = true;
  alignas(64) IdOf<T> target[kPacketSize];  ///< object that does not occlude: the ray's light, or kNone
  IdOf<T> occluded[kPacketSize];            ///< out: all bits set if a sphere is hit in 0 < t < distance, else 0
};

/// How the kernel queries the scene, in one precision. Queries take an array of packets. Their results do not depend on
/// the order of traversal: of two closest hits the smaller distance wins, then the smaller id, and occlusion is an OR
/// over all spheres. Objects that are not visible to a ray (SceneView::opacity) are not there.
struct Tracer {
  void (*trace)(const void* self, void* ray_packets, int count) = nullptr;
  void (*occlude)(const void* self, void* shadow_packets, int count) = nullptr;
  const void* self = nullptr;
  std::int64_t target = 0;  ///< instruction set that the functions were compiled for, HWY_AVX2 etc.; 0: unknown
};

/// Finds the closest hits of `count` packets.
///
/// Domain     T is the number type of the tracer's precision; 1 <= count <= kPacketsInFlight
template <class T>
inline void trace(const Tracer& tracer, RayPacket<T>* packets, int count) {
  tracer.trace(tracer.self, packets, count);
}
template <class T>
inline void trace(const Tracer& tracer, RayPacket<T>& packet) {
  trace(tracer, &packet, 1);
}

/// Determines which rays of `count` packets are occluded.
///
/// Domain     as for trace()
template <class T>
inline void occlude(const Tracer& tracer, ShadowPacket<T>* packets, int count) {
  tracer.occlude(tracer.self, packets, count);
}
template <class T>
inline void occlude(const Tracer& tracer, ShadowPacket<T>& packet) {
  occlude(tracer, &packet, 1);
}

/// A query of a Tracer, from a function for one packet.
template <class Packet, void (*kQuery)(const void* self, Packet& packet)>
void query_each(const void* self, void* packets, int count) {
  for (int i = 0; i < count; ++i) kQuery(self, static_cast<Packet*>(packets)[i]);
}

/// Resets all rays of a packet to no hit, with an unlimited maximum distance.
template <class T>
inline void reset_hits(RayPacket<T>& packet) {
  std::fill_n(packet.distance, kPacketSize, std::numeric_limits<T>::max());
  std::fill_n(packet.hit, kPacketSize, IdOf<T>{kNone});
}

}  // namespace orrery::kernel
