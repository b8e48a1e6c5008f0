// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/ray_packet.h"

namespace orrery::kernel {

/// Number of paths in a stream: enough to fill packets at deep bounces, few enough to stay in the cache.
inline constexpr int kStreamSize = 1024;

/// The state of a tile's paths between two vertices, as a structure of arrays.
///
/// The end of the arrays is read and written in whole vectors, hence the capacity for one more packet.
template <class T, class Id>
struct alignas(64) PathStreamOf {
  static constexpr int kCapacity = kStreamSize + kPacketSize;
  T base[3][kCapacity];        ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];      ///< from there to the ray's origin
  T direction[3][kCapacity];   ///< unit
  T throughput[3][kCapacity];  ///< product of reflectances so far
  Id self[kCapacity];          ///< sphere that the ray leaves
  Id pixel[kCapacity];         ///< y << 16 | x
  Id sample[kCapacity];
  Id history[kCapacity];      ///< only in loops that record paths; see record-inl.h
  RayPacketOf<T, Id> packet;  ///< the rays being traced
  T radiance[3][kCapacity];   ///< collected so far; only in loops that collect light along the path
};

using PathStream = PathStreamOf<double, std::uint64_t>;
using PathStreamFast = PathStreamOf<float, std::uint32_t>;

}  // namespace orrery::kernel
