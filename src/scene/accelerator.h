// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::scene {

/// The data structure that finds the closest sphere along a ray. The image does not depend on it.
enum class Accelerator {
  kEmbree,  ///< a BVH
  kList,    ///< a loop over all spheres
};

/// Order in which rays traverse Embree's BVH. The image does not depend on it.
enum class Traversal {
  kAuto,    ///< the faster one, in the first packets of each thread
  kPacket,  ///< 16 rays together
  kSingle,  ///< one ray after the other
};

}  // namespace orrery::scene
