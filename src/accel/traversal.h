// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::accel {

/// How rays traverse the BVH. Hits do not depend on it.
enum class Traversal : std::uint8_t {
  kPacket,  ///< the rays of a packet together, which pays off as long as they visit the same nodes
  kSingle,  ///< each ray separately
};

/// The traversal of camera rays and that of scattered rays.
struct Traversals {
  Traversal camera = Traversal::kPacket, secondary = Traversal::kPacket;
};

}  // namespace orrery::accel
