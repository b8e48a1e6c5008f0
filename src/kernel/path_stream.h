// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>

#include "kernel/ray_packet.h"

namespace orrery::kernel {

/// Number of paths in a stream: enough to fill packets at deep bounces, few enough to stay in the cache.
inline constexpr int kStreamSize = 1024;

/// Number of bits of a path's index within the batch. Its CausticState is in the bits above, so that it costs nothing
/// in scenes without caustics.
inline constexpr int kPathBits = 16;
static_assert(kStreamSize < 1 << kPathBits);

/// Capacity of arrays with an element for each path of a batch. Whole vectors and packets are stored at their ends.
inline constexpr int kPathCapacity = kStreamSize + kPacketSize;

/// What a batch's paths keep from start to end, by index within the batch: all samples of a pixel, then those of the
/// next pixel.
///
/// Radiance is deposited when all paths of the batch have ended, so that a bad value removes the path's weight only
/// once.
template <class T>
struct alignas(64) BatchOf {
  T radiance[3][kPathCapacity];  ///< that the camera has received so far
  T coverage[kPathCapacity];     ///< 1 less the share of the background; below 0 on SceneView::page, see add_coverage()
  IdOf<T> pixel[kPathCapacity];  ///< y << 16 | x
  IdOf<T> sample[kPathCapacity];
};

/// The paths of a batch that are alive, between two vertices. By position in the stream, in the order of their indices:
/// at each vertex the survivors move to the front.
template <class T>
struct alignas(64) PathStreamOf {
  using Id = IdOf<T>;
  T base[3][kPathCapacity];        ///< centre of the sphere that the ray leaves
  T offset[3][kPathCapacity];      ///< from that centre to the ray's origin
  T direction[3][kPathCapacity];   ///< unit
  T throughput[3][kPathCapacity];  ///< product of reflectances so far
  Id self[kPathCapacity];          ///< object that the ray leaves
  Id path[kPathCapacity];          ///< index within the batch and CausticState, see kPathBits
  Id pixel[kPathCapacity];         ///< as in BatchOf, since each vertex needs them for its random numbers
  Id sample[kPathCapacity];
  Id history[kPathCapacity];  ///< only if the tile is recorded; see record-inl.h
  T pdf[kPathCapacity];       ///< only if features.lit: density of the direction, per steradian; infinite: delta
  T cone[3][kPathCapacity];   ///< only if the scene has ray cones: see cone-inl.h
};

/// Points at which paths wait for light, until they fill packets or vectors. Padded like arrays of paths.
template <class T, int kMost>
struct alignas(64) WaitingPointsOf {
  using Id = IdOf<T>;
  static constexpr int kCapacity = kMost + 2 * kPacketSize;
  T base[3][kCapacity];    ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];  ///< from that centre to the ray's origin
  T value[3][kCapacity];   ///< throughput and weight; of rays times the radiance of the light
  T time[kCapacity];       ///< 0..1 within the shutter; only if the scene moves
  T threshold[kCapacity];  ///< as in PacketRays; only if the scene has opacities
  Id self[kCapacity];      ///< object that the ray leaves
  Id path[kCapacity];      ///< index within the batch
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

/// Diffuse vertices at which light by way of balls is sampled, until they fill vectors; see caustic_sampling-inl.h.
template <class T>
struct CausticVerticesOf : WaitingPointsOf<T, kCausticBatch> {
  using WaitingPointsOf<T, kCausticBatch>::kCapacity;
  alignas(64) T side[kCapacity];  ///< 1 outside of the sphere, -1 inside
  T uniform[kCapacity];           ///< 1: the lobe is uniform; 0: Lambertian
  T random[4][kCapacity];         ///< two numbers for the direction, for the choices of the light and of a piece
  IdOf<T> ball[kCapacity];        ///< index into Caustics
};

/// Rays that follow chains of events through balls and wait until they fill packets; see caustic_transport-inl.h.
/// Directions are unit.
template <class T>
struct CausticRaysOf : WaitingRaysOf<T, CausticVerticesOf<T>::kCapacity> {
  using WaitingRaysOf<T, CausticVerticesOf<T>::kCapacity>::kCapacity;
  IdOf<T> events[kCapacity];  ///< that are left; see CausticEvent
  IdOf<T> ball[kCapacity];    ///< that causes them
  IdOf<T> inner[kCapacity];   ///< its inner sphere, if it is hollow
  IdOf<T> light[kCapacity];   ///< the emitter, or kSun
  RayPacket<T> packet;        ///< the rays being traced
};

/// All that the path loop keeps in memory, as structures of arrays.
template <class T>
struct alignas(64) PathsOf {
  PathStreamOf<T> stream;
  BatchOf<T> batch;
  RayPacket<T> packets[kPacketsInFlight];  ///< the stream's rays being traced
  // Only in full loops:
  ShadowStreamOf<T> shadow;
  CausticVerticesOf<T> vertices;
  CausticRaysOf<T> caustic_rays;
};

/// Memory for the paths of a tile, in any precision.
struct alignas(64) PathStream {
  std::byte bytes[sizeof(PathsOf<double>)];

  /// The paths of a loop, uninitialized.
  template <class T>
  PathsOf<T>& as() noexcept {
    return *new (bytes) PathsOf<T>;
  }
};

}  // namespace orrery::kernel
