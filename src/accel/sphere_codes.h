// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "accel/box_frame.h"
#include "accel/sphere_bvh.h"
#include "kernel/rod.h"

/// How the nodes and leaves of a SphereBvh store bounds, spheres and rods in 8 bits per number.
namespace orrery::accel {

/// A sphere while its BVH is built.
struct SphereItem {
  float center[3];  ///< box space
  std::uint32_t id;
};

inline constexpr std::size_t kArity = SphereBvh::kArity;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The components of the half axes of rods are at most this many steps.
inline constexpr double kLargestHalfCode = 127;

struct Bounds {
  float lower[3] = {kInfinity, kInfinity, kInfinity};
  float upper[3] = {-kInfinity, -kInfinity, -kInfinity};

  void add(const float (&low)[3], const float (&high)[3]) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], low[k]);
      upper[k] = std::max(upper[k], high[k]);
    }
  }
  void add(const Bounds& b) { add(b.lower, b.upper); }
};

/// A rod's half axis and radius, in box space.
struct RodExtent {
  double half[3], radius;

  RodExtent(const kernel::Rod& rod, const BoxFrame& frame) : radius(rod.radius * frame.scale) {
    for (int axis = 0; axis < 3; ++axis) half[axis] = (rod.b[axis] - rod.a[axis]) / 2 * frame.scale;
  }
};

/// The code of an upper bound, at least: the decoded bound is not below `bound`.
///
/// Domain     `bound` is between the origin and the decoded value of 255
std::uint8_t code_above(float bound, float origin, float step);

/// The smallest step with which 255 steps from `lower` reach `upper`.
float step_between(float lower, float upper);

/// `children`  their padded bounds
/// `first`     reference to the first child
SphereBvh::Node make_node(std::span<const Bounds> children, std::uint32_t first);

SphereBvh::Leaf make_leaf(std::span<const SphereItem> items);

/// `count`    number of items of the leaf
SphereBvh::LeafRods make_leaf_rods(const SphereBvh::Leaf& leaf, std::size_t count, const BoundedSpheres& spheres,
                                   const BoundedRods& rods, const BoxFrame& frame);

}  // namespace orrery::accel
