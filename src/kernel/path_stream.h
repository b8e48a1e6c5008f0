// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>

#include "kernel/ray_packet.h"

namespace orrery::kernel {

/// Number of paths in a stream: enough to fill packets at deep bounces, few enough to stay in the cache.
inline constexpr int kStreamSize = 1024;

/// Number of bits of a path's index within the batch. Its chain, see caustic_partition-inl.h, is in the bits above, so
/// that paths cost nothing more in scenes without caustics.
inline constexpr int kPathBits = 16;
static_assert(kStreamSize < 1 << kPathBits);

/// Points at which paths wait for light, until they fill packets or vectors.
///
/// The arrays are padded, because whole vectors are stored at their ends.
template <class T, int kMost>
struct alignas(64) WaitingPointsOf {
  using Id = IdOf<T>;
  static constexpr int kCapacity = kMost + 2 * kPacketSize;
  T base[3][kCapacity];    ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];  ///< from that centre to the ray's origin
  T value[3][kCapacity];   ///< throughput and weight; of rays times the radiance of the light
  T time[kCapacity];       ///< 0..1 within the shutter; only if the scene moves
  Id key[kCapacity];       ///< see PacketRays, in the low 32 bits; only if the scene has opacities
  Id self[kCapacity];      ///< sphere that the ray leaves
  Id path[kCapacity];      ///< index into LitPathsOf
  Id history[kCapacity];   ///< only if the tile has light events
  int count = 0;
};

/// Rays from such points.
template <class T, int kMost>
struct WaitingRaysOf : WaitingPointsOf<T, kMost> {
  using WaitingPointsOf<T, kMost>::kCapacity;
  alignas(64) T direction[3][kCapacity];
  IdOf<T> group[kCapacity];  ///< light group; only if the tile has light events
};

/// Shadow rays: those that wait for a query, and those that a packet of paths adds to them. Directions have any length.
template <class T>
struct ShadowStreamOf : WaitingRaysOf<T, kPacketsInFlight * kPacketSize> {
  static constexpr int kBatch = kPacketsInFlight * kPacketSize;
  using WaitingRaysOf<T, kBatch>::kCapacity;
  T distance[kCapacity];            ///< maximum distance of an occluder, as a multiple of the direction's length
  IdOf<T> target[kCapacity];        ///< the light, or kNone
  T coat[3][kCapacity];             ///< part of `value` that a coat scatters; only if the history has kCoatBit
  IdOf<T> coat_history[kCapacity];  ///< history of that part
  ShadowPacket<T> packets[kPacketsInFlight];  ///< the rays being traced
};

/// Number of diffuse vertices that wait. Several packets, since shadow rays are traced first, in packets that may not
/// be full.
inline constexpr int kCausticBatch = 8 * kPacketSize;

/// Diffuse vertices at which light by way of balls is sampled, until they fill vectors; see caustic_light-inl.h.
template <class T>
struct CausticVerticesOf : WaitingPointsOf<T, kCausticBatch> {
  using WaitingPointsOf<T, kCausticBatch>::kCapacity;
  alignas(64) T side[kCapacity];  ///< 1 outside of the sphere, -1 inside
  T uniform[kCapacity];           ///< 1: the lobe is uniform; 0: Lambertian
  T random[4][kCapacity];         ///< two numbers for the direction, for the choices of the light and of a piece
  IdOf<T> ball[kCapacity];        ///< index into Caustics
};

/// Rays of chains that wait until they fill packets; see caustic_rays-inl.h. Directions are unit.
template <class T>
struct ChainStreamOf : WaitingRaysOf<T, CausticVerticesOf<T>::kCapacity> {
  using WaitingRaysOf<T, CausticVerticesOf<T>::kCapacity>::kCapacity;
  IdOf<T> events[kCapacity];  ///< that are left; see CausticEvent
  IdOf<T> ball[kCapacity];    ///< that causes them
  IdOf<T> inner[kCapacity];   ///< its inner sphere, if it is hollow
  IdOf<T> light[kCapacity];   ///< the emitter, or kSun
  RayPacket<T> packet;        ///< the rays being traced
};

/// State of paths that gain radiance at their vertices.
///
/// A path's radiance is stored at its index within the batch and deposited when all paths of the batch have ended, so
/// that a bad value removes the path's weight only once.
template <class T>
struct alignas(64) LitPathsOf {
  using Id = IdOf<T>;
  static constexpr int kCapacity = kStreamSize + kPacketSize;
  Id path[kCapacity];        ///< of each path of the stream: its index within the batch and its chain, see kPathBits
  T pdf[kCapacity];          ///< density of the direction of each path of the stream, per steradian; infinite: delta
  T radiance[3][kCapacity];  ///< by index within the batch
  Id pixel[kCapacity];       ///< by index within the batch
  Id sample[kCapacity];      ///< by index within the batch
  ShadowStreamOf<T> shadow;
  CausticVerticesOf<T> vertices;
  ChainStreamOf<T> chains;
};

/// The state of a tile's paths between two vertices, as a structure of arrays.
///
/// Whole vectors are read and written at the ends of the arrays, hence the capacity for one more packet.
template <class T>
struct alignas(64) PathStreamOf {
  using Id = IdOf<T>;
  static constexpr int kCapacity = kStreamSize + kPacketSize;
  T base[3][kCapacity];        ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];      ///< from that centre to the ray's origin
  T direction[3][kCapacity];   ///< unit
  T throughput[3][kCapacity];  ///< product of reflectances so far
  Id self[kCapacity];          ///< sphere that the ray leaves
  Id pixel[kCapacity];         ///< y << 16 | x
  Id sample[kCapacity];
  Id history[kCapacity];                   ///< only if the tile is recorded; see record-inl.h
  RayPacket<T> packets[kPacketsInFlight];  ///< the rays being traced
  LitPathsOf<T> lit;                       ///< only in full loops
  T cone[3][kCapacity];                    ///< only in full loops, if the scene has ray cones; see cone-inl.h
};

/// Memory for the paths of a tile, in any precision.
struct alignas(64) PathStream {
  std::byte bytes[sizeof(PathStreamOf<double>)];

  /// The stream of a loop, uninitialized.
  template <class T>
  PathStreamOf<T>& as() noexcept {
    return *new (bytes) PathStreamOf<T>;
  }
};

}  // namespace orrery::kernel
