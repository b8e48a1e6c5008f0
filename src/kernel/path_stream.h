// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/ray_packet.h"

namespace orrery::kernel {

/// Paths that are traced together: enough to fill packets down to the deeper bounces, few enough to stay in the cache.
inline constexpr int kStreamSize = 1024;

/// The state of the paths of a tile between two of their vertices, component by component.
///
/// The packed end of the arrays is read and written in whole vectors, hence the room for one more packet.
template <class T, class Id>
struct alignas(64) PathStreamOf {
  static constexpr int kCapacity = kStreamSize + kPacketSize;
  T base[3][kCapacity];        ///< centre of the sphere that the ray leaves
  T offset[3][kCapacity];      ///< from there to the ray's origin
  T direction[3][kCapacity];   ///< unit
  T throughput[3][kCapacity];  ///< share of each colour that is left
  Id self[kCapacity];          ///< sphere that the ray leaves
  Id pixel[kCapacity];         ///< y << 16 | x
  Id sample[kCapacity];
  Id history[kCapacity];      ///< in use only where paths are recorded
  RayPacketOf<T, Id> packet;  ///< the rays that are being traced
};

using PathStream = PathStreamOf<double, std::uint64_t>;
using PathStreamFast = PathStreamOf<float, std::uint32_t>;

}  // namespace orrery::kernel
