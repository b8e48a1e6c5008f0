// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "accel/accel.h"
#include "accel/box_frame.h"
#include "base/huge_pages.h"
#include "kernel/rod.h"
#include "kernel/sphere.h"

namespace orrery::accel {

/// A BVH over many spheres and static rods, for one Embree primitive: 16 children per node, 16 spheres per leaf, bounds
/// in 8 bits relative to the parent. It takes 10 to 12 bytes per sphere, and one more if radii differ.
///
/// A moving sphere is in the tree as the sphere that encloses it while the shutter is open. Leaves then also hold the
/// paths of their spheres, so that rays test them where they are at the time of the ray.
///
/// A rod is in the tree as the sphere around its middle that encloses it. Leaves then also hold the axes of their rods,
/// which takes 4 bytes more per sphere and rod.
///
/// Like Embree's boxes, it only selects candidates. All bounds enclose the spheres plus the rounding errors of a
/// single-precision ray in box space (docs/decisions/0027-bvh-for-many-spheres.md), so no hit is lost.
class SphereBvh {
 public:
  /// Children of a node and spheres of a leaf.
  static constexpr unsigned kArity = 16;

  /// Centres, in box space: origin + step * center, which is at most step / 2 off on each axis.
  struct alignas(64) Leaf {
    std::uint8_t center[3][kArity];
    float origin[3];
    float step;
    std::uint32_t ids[kArity];  ///< of spheres and of the first halves of rods; kNone beyond the last one
  };

  /// Radii of a leaf's spheres, the largest while the shutter is open, if they differ between spheres: at most step *
  /// radius, box space.
  struct LeafRadii {
    std::uint8_t radius[kArity];
    float step;
  };

  /// The rods of a leaf, and the paths of its spheres, in box space.
  struct alignas(64) LeafRods {
    /// From the middle to the end of a rod, or of a sphere's path: step * half, at most step / 2 off on each axis.
    std::int8_t half[3][kArity];
    float step;
    float radius, least_radius;  ///< the largest and the smallest, rounded outwards
    std::uint32_t rods;          ///< which items are rods, as bits
  };

  /// Boxes of the children, in box space: origin + step * bound. Beyond the last child, lower bounds are 255 and upper
  /// bounds 0, so that no ray enters.
  struct alignas(64) Node {
    std::uint8_t bound[2][3][kArity];  ///< [lower, upper][axis][child]
    float origin[3];
    std::uint32_t first;  ///< reference to the first child, encoded like `root()`
    float step[3];
    std::uint32_t count;  ///< number of children
  };

  /// A region of box space that no sphere below any other node reaches into. Empty if lower > upper. The fourth
  /// dimension is unbounded: a vector of four floats holds a bound.
  struct Cell {
    float lower[4], upper[4];
  };

  /// Set in references to leaves; the other bits are the index of the leaf or node.
  static constexpr std::uint32_t kLeafBit = 0x80000000u;

  /// Traversal stack size: 15 siblings on each level, the node visited last, and the end marker.
  static constexpr std::size_t kMaxDepth = 8, kStackSize = kMaxDepth * (kArity - 1) + 2;

  /// Maximum number of spheres that references and kMaxDepth allow.
  static constexpr std::size_t kMaxSpheres = (std::size_t{1} << 31) - kArity;

  /// With more spheres there are no start nodes: rays start at the root, which costs a few percent of their time and
  /// saves 3 bytes of 24 per sphere.
  static constexpr std::size_t kMostStartNodes = std::size_t{1} << 27;

  /// Spheres that are in memory as items at a time while the BVH is built, see SphereSort: at most a quarter of all,
  /// where that saves memory to speak of.
  static constexpr std::size_t part_size(std::size_t count) { return std::size_t{1} << (count >> 26 > 0 ? 24 : 20); }

  SphereBvh() = default;

  /// `ids`            of spheres and of the first halves of rods; the rods do not move
  /// `monitor`        receives the progress, 0..1, on any thread; returns false to cancel
  /// `size_of_parts`  a power of kArity, at least its square; 0: part_size(); the result does not depend on it
  /// Domain           1 <= ids.size() <= kMaxSpheres; all spheres and rods lie in the frame
  /// Errors           base::Error(kStopped) if the monitor cancelled the build
  SphereBvh(const BoundedSpheres& spheres, std::vector<std::uint32_t> ids, const BoxFrame& frame,
            const std::function<bool(double)>& monitor = {}, const BoundedRods& rods = {},
            std::size_t size_of_parts = 0);

  /// Memory at the peak of a build.
  static std::uint64_t bytes_of_build(const ObjectCounts& objects) noexcept;

  bool empty() const noexcept { return leaves.empty(); }
  std::uint32_t root() const noexcept { return static_cast<std::uint32_t>(nodes.size() - 1); }
  std::size_t bytes() const noexcept;

  /// The node above the leaf of a sphere or rod; kNone if it is not in the tree, or if there are no start nodes.
  ///
  /// `object`   kernel::RodArray::object()
  std::uint32_t start_node(std::size_t object) const noexcept {
    const std::uint32_t node = object < start_nodes.size() ? start_nodes[object] : no_start_node;
    return node == no_start_node ? kernel::kNone : node;
  }

  /// Spheres in a leaf; all leaves but the last are full.
  unsigned count_in(std::uint32_t leaf) const noexcept {
    const std::size_t rest = count - std::size_t{leaf} * kArity;
    return rest < kArity ? static_cast<unsigned>(rest) : kArity;
  }

  bool has_rods_in(std::uint32_t leaf) const noexcept { return !rods.empty() && rods[leaf].rods != 0; }

  std::size_t count = 0;  ///< number of spheres and rods
  /// For each object of the scene, the node above its leaf, or no_start_node. Empty above kMostStartNodes.
  base::PackedArray start_nodes;
  std::uint32_t no_start_node = 0;  ///< stands for spheres that are not in the tree
  base::HugeVector<Leaf> leaves;
  base::HugeVector<LeafRadii> radii;                   ///< one per leaf; empty if all spheres have `radius`
  base::HugeVector<LeafRods> rods;                     ///< one per leaf; empty if there are no rods and nothing moves
  base::HugeVector<Node> nodes;                        ///< level by level, those above the leaves first
  base::HugeVector<Cell> cells;                        ///< one per node
  std::array<std::uint32_t, kMaxDepth> level_begin{};  ///< index of the first node of each level
  std::uint32_t last_leaf = 0;                         ///< the only one that may have fewer than kArity spheres
  float radius = 0;                                    ///< box space, the largest while the shutter is open, rounded up
  bool moves = false;                                  ///< spheres do
  /// A sphere whose radius is less by this, around the same centre, is inside the moving one at all times; box space.
  float spread = 0;
  /// Covers the rounding of the distance between a ray and the axis of a rod, times LeafRods::step.
  float axis_slack = 0;
  float padding = 0;    ///< added to a sphere's radius to cover rounding errors of a ray's distance from it, box space
  BoxFrame::Box box{};  ///< padded bounds of all spheres
};

/// The sphere around a rod's middle that encloses the rod.
kernel::Sphere enclosing_sphere(const kernel::Rod& rod) noexcept;
/// The rod that a moving sphere passes through while the shutter is open.
kernel::Rod path_of(const BoundedSpheres& spheres, std::size_t id) noexcept;
/// The sphere that encloses a sphere while the shutter is open.
kernel::Sphere enclosing_sphere(const BoundedSpheres& spheres, std::size_t id) noexcept;

}  // namespace orrery::accel
