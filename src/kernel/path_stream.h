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

/// Shadow rays that wait until they fill packets, and the light that they carry if they are not occluded.
///
/// The arrays are padded, because whole vectors are stored at their ends.
template <class T>
struct alignas(64) ShadowStreamOf {
  using Id = IdOf<T>;
  /// Rays that wait for a query, and those that a packet of paths adds to them.
  static constexpr int kBatch = kPacketsInFlight * kPacketSize, kCapacity = kBatch + 2 * kPacketSize;
  T base[3][kCapacity];        ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];      ///< from that centre to the ray's origin
  T direction[3][kCapacity];   ///< to the light; of any length
  T distance[kCapacity];       ///< maximum distance of an occluder, as a multiple of the direction's length
  T time[kCapacity];           ///< 0..1 within the shutter; only if the scene moves
  Id key[kCapacity];           ///< see PacketRays, in the low 32 bits; only if the scene has opacities
  T light[3][kCapacity];       ///< radiance times throughput and weight
  Id self[kCapacity];          ///< sphere that the ray leaves
  Id target[kCapacity];        ///< the light, or kNoSphere
  Id path[kCapacity];          ///< index into LitPathsOf
  Id history[kCapacity];       ///< only in loops that record paths
  Id group[kCapacity];         ///< light group; only in loops that record paths
  T coat[3][kCapacity];        ///< part of `light` that a coat scatters; only if the history has kCoatBit
  Id coat_history[kCapacity];  ///< history of that part
  int count = 0;
  ShadowPacket<T> packets[kPacketsInFlight];  ///< the rays being traced
};

/// Diffuse vertices at which light by way of balls is sampled, until they fill vectors; see caustic_light-inl.h.
template <class T>
struct alignas(64) CausticVerticesOf {
  using Id = IdOf<T>;
  /// Vertices that wait. Several packets, since shadow rays are traced first, in packets that may not be full.
  static constexpr int kBatch = 8 * kPacketSize;
  static constexpr int kCapacity = kBatch + 2 * kPacketSize;
  T base[3][kCapacity];    ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];  ///< from that centre to the ray's origin
  T side[kCapacity];       ///< 1 outside of the sphere, -1 inside
  T uniform[kCapacity];    ///< 1: the lobe is uniform; 0: Lambertian
  T value[3][kCapacity];   ///< throughput divided by the probability of being sampled
  T random[4][kCapacity];  ///< two numbers for the direction, for the choices of the light and of a piece
  T time[kCapacity];       ///< 0..1 within the shutter; only if the scene moves
  Id key[kCapacity];       ///< see PacketRays, in the low 32 bits; only if the scene has opacities
  Id self[kCapacity];      ///< sphere that the ray leaves
  Id ball[kCapacity];      ///< index into Caustics
  Id path[kCapacity];      ///< index into LitPathsOf
  Id history[kCapacity];   ///< only in loops that record paths
  int count = 0;
};

/// Rays of chains that wait until they fill packets; see caustic_rays-inl.h.
template <class T>
struct alignas(64) ChainStreamOf {
  using Id = IdOf<T>;
  static constexpr int kCapacity = CausticVerticesOf<T>::kCapacity + 2 * kPacketSize;
  T base[3][kCapacity];       ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];     ///< from that centre to the ray's origin
  T direction[3][kCapacity];  ///< unit
  T time[kCapacity];          ///< 0..1 within the shutter; only if the scene moves
  Id key[kCapacity];          ///< see PacketRays, in the low 32 bits; only if the scene has opacities
  T value[3][kCapacity];      ///< radiance times throughput and weight
  Id self[kCapacity];         ///< sphere that the ray leaves
  Id events[kCapacity];       ///< that are left; see CausticEvent
  Id ball[kCapacity];         ///< that causes them
  Id inner[kCapacity];        ///< its inner sphere, if it is hollow
  Id light[kCapacity];        ///< the emitter, or kNoSphere: the sun
  Id path[kCapacity];         ///< index into LitPathsOf
  Id history[kCapacity];      ///< only in loops that record paths
  Id group[kCapacity];        ///< light group; only in loops that record paths
  int count = 0;
  RayPacket<T> packet;  ///< the rays being traced
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
  Id history[kCapacity];                   ///< only in loops that record paths; see record-inl.h
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
