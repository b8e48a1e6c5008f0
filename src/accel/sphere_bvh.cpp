// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_bvh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "accel/sphere_codes.h"
#include "accel/sphere_sort.h"
#include "base/huge_pages.h"
#include "base/parallel.h"
#include "base/stop_point.h"
#include "math/scalar.h"

namespace orrery::accel {
namespace {

using math::rounded_up;

/// Padding in units of the frame's reach. Derived in docs/decisions/0027-bvh-for-many-spheres.md: rounding moves a
/// ray by at most 40 x 2^-24 relative to a sphere and by at most 19 x 2^-24 relative to a box.
constexpr double kSpherePadding = 0x1.4p-17, kBoxPadding = 0x1p-18;

/// Rounding error of the triple product of a ray's direction, the half axis of a rod, and the vector between them, in
/// units of the frame's reach times the length of the half axis: at most 8 x 2^-24 of that vector, whose length is at
/// most 2.5 reaches. The half axis is at most sqrt(3) x 127 steps long.
constexpr double kAxisSlack = 0x1p-18 * 1.7321 * kLargestHalfCode;

/// Builds a SphereBvh.
class Builder {
 public:
  Builder(SphereBvh& bvh, const EnclosingSpheres& spheres, std::vector<std::uint32_t> ids)
      : bvh_(bvh), spheres_(spheres), ids_(std::move(ids)) {}

  void run(const SphereSort::Monitor& monitor, std::size_t part_size) {
    measure();
    reserve();
    SphereSort sort(bvh_.count, part_size, static_cast<float>(mean_radius_), bvh_.radius + 2 * box_padding_, monitor);
    for (const SphereSort::Part& part : sort.divide(spheres_, ids_)) {
      const std::span<SphereItem> items = take_items(part);
      sort.sort(part, items);
      add_leaves(part, items);
    }
    base::HugeVector<SphereItem>().swap(items_);
    add_nodes(sort);
  }

 private:
  using Range = tbb::blocked_range<std::size_t>;

  /// Determines the radii, and whether there are rods.
  void measure() {
    struct Radii {
      double least = std::numeric_limits<double>::infinity(), largest = 0, sum = 0;
      bool has_rods = false;
    };
    const Radii radii = base::accumulate_parallel(
        ids_.size(), Radii(),
        [&](Radii& all, std::size_t i) {
          const double r = spheres_[ids_[i]].radius;
          all.has_rods = all.has_rods || spheres_.rods.rods.contains(ids_[i]);
          all.least = std::min(all.least, r);
          all.largest = std::max(all.largest, r);
          all.sum += r;
        },
        [](Radii& a, const Radii& b) {
          a = {std::min(a.least, b.least), std::max(a.largest, b.largest), a.sum + b.sum, a.has_rods || b.has_rods};
        });
    has_rods_ = radii.has_rods;
    own_radii_ = radii.least < radii.largest || has_rods_;
    mean_radius_ = radii.sum / static_cast<double>(ids_.size()) * spheres_.frame.scale;
    bvh_.radius = rounded_up(radii.largest * spheres_.frame.scale);
    bvh_.padding = rounded_up(kSpherePadding * spheres_.frame.reach);
    bvh_.axis_slack = rounded_up(kAxisSlack * spheres_.frame.reach);
    box_padding_ = rounded_up(kBoxPadding * spheres_.frame.reach);
  }

  /// Reserves memory, which is touched when it is needed.
  void reserve() {
    const std::size_t leaves = parents_of(bvh_.count);
    std::size_t nodes = 0;
    for (std::size_t level = leaves; level > 1 || nodes == 0; nodes += level) level = parents_of(level);
    bvh_.leaves.reserve(leaves);
    if (own_radii_) bvh_.radii.reserve(leaves);
    if (has_rods_) bvh_.rods.reserve(leaves);
    bvh_.nodes.reserve(nodes);
    bvh_.cells.reserve(nodes);
    above_leaves_.reserve(parents_of(leaves));
    bvh_.last_leaf = static_cast<std::uint32_t>(leaves - 1);
    bvh_.no_start_node = static_cast<std::uint32_t>(parents_of(leaves));
    if (bvh_.count > SphereBvh::kMostStartNodes) return;
    const std::size_t last = spheres_.rods.rods.object(*std::max_element(ids_.begin(), ids_.end()));
    bvh_.start_nodes = base::PackedArray(last + 1, bvh_.no_start_node);
  }

  /// Replaces the ids of a part by items, and returns their memory.
  std::span<SphereItem> take_items(const SphereSort::Part& part) {
    items_.resize(std::max(items_.size(), part.count));
    const std::span items(items_.data(), part.count);
    const std::span<std::uint32_t> ids(&ids_[part.begin], part.count);
    const base::StopPoint stop;
    tbb::parallel_for(Range(0, part.count, 4096), [&](const Range& range) {
      stop.check();
      for (std::size_t i = range.begin(); i < range.end(); ++i) items[i] = spheres_.item(ids[i]);
    });
    base::release_memory(ids);
    return items;
  }

  /// Adds the leaves of a part and the nodes above them.
  void add_leaves(const SphereSort::Part& part, std::span<const SphereItem> items) {
    const std::size_t first = bvh_.leaves.size(), count = parents_of(part.count), first_node = bvh_.nodes.size();
    bvh_.leaves.resize(first + count);
    if (own_radii_) bvh_.radii.resize(first + count);
    if (has_rods_) bvh_.rods.resize(first + count);
    bvh_.nodes.resize(first_node + parents_of(count));
    above_leaves_.resize(bvh_.nodes.size());
    const base::StopPoint stop;
    tbb::parallel_for(Range(0, parents_of(count), 16), [&](const Range& range) {
      stop.check();
      for (std::size_t n = range.begin(); n < range.end(); ++n) {
        Bounds children[kArity];
        const std::size_t below = n * kArity, here = std::min(kArity, count - below);
        for (std::size_t i = 0; i < here; ++i) {
          const std::size_t begin = (below + i) * kArity;
          children[i] = add_leaf(first + below + i, items.subspan(begin, std::min(kArity, items.size() - begin)));
        }
        const auto child = static_cast<std::uint32_t>(first + below);
        add_node(first_node + n, std::span(children, here), child | SphereBvh::kLeafBit, above_leaves_[first_node + n]);
      }
    });
  }

  /// Sets a leaf.
  ///
  /// Result     padded bounds of its spheres
  Bounds add_leaf(std::size_t index, std::span<const SphereItem> items) {
    const kernel::RodArray& rods = spheres_.rods.rods;
    const BoxFrame& frame = spheres_.frame;
    bvh_.leaves[index] = make_leaf(items);
    Bounds bounds;
    float r[kArity], most = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto& [center, id] = items[i];
      if (bvh_.start_nodes.size() > 0)
        bvh_.start_nodes.set(rods.object(id), static_cast<std::uint32_t>(index / kArity));
      r[i] = own_radii_ ? rounded_up(spheres_[id].radius * frame.scale) : bvh_.radius;
      most = std::max(most, r[i]);
      float reach[3] = {r[i], r[i], r[i]}, lower[3], upper[3];
      if (rods.contains(id)) {
        const RodExtent rod(spheres_.rods.at(rods.index(id), 0), frame);
        for (int axis = 0; axis < 3; ++axis) reach[axis] = rounded_up(std::abs(rod.half[axis]) + rod.radius);
      }
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = center[axis] - (reach[axis] + box_padding_);
        upper[axis] = center[axis] + (reach[axis] + box_padding_);
      }
      bounds.add(lower, upper);
    }
    if (!own_radii_) return bounds;
    bvh_.radii[index] = {{}, step_between(0, most)};
    for (std::size_t i = 0; i < items.size(); ++i)
      bvh_.radii[index].radius[i] = code_above(r[i], 0, bvh_.radii[index].step);
    if (has_rods_) bvh_.rods[index] = make_leaf_rods(bvh_.leaves[index], items.size(), spheres_.rods, frame);
    return bounds;
  }

  void add_node(std::size_t index, std::span<const Bounds> children, std::uint32_t first, Bounds& all) {
    bvh_.nodes[index] = make_node(children, first);
    for (const Bounds& child : children) all.add(child);
  }

  /// Adds the nodes of the upper levels.
  void add_nodes(const SphereSort& sort) {
    std::vector<Bounds> below = std::move(above_leaves_);
    std::size_t level = 0, first = 0;
    while (true) {
      bvh_.cells.insert(bvh_.cells.end(), sort.cells(level).begin(), sort.cells(level).end());
      bvh_.level_begin[level++] = static_cast<std::uint32_t>(first);
      if (below.size() == 1) break;
      const std::size_t begin = bvh_.nodes.size();
      std::vector<Bounds> above(parents_of(below.size()));
      bvh_.nodes.resize(begin + above.size());
      tbb::parallel_for(Range(0, above.size(), 64), [&](const Range& range) {
        for (std::size_t n = range.begin(); n < range.end(); ++n) {
          const std::size_t child = n * kArity, count = std::min(kArity, below.size() - child);
          add_node(begin + n, std::span(&below[child], count), static_cast<std::uint32_t>(first + child), above[n]);
        }
      });
      first = begin;
      below = std::move(above);
    }
    std::copy_n(below[0].lower, 3, bvh_.box.lower);
    std::copy_n(below[0].upper, 3, bvh_.box.upper);
  }

  static std::size_t parents_of(std::size_t count) { return (count + kArity - 1) / kArity; }

  SphereBvh& bvh_;
  const EnclosingSpheres& spheres_;
  std::vector<std::uint32_t> ids_;
  base::HugeVector<SphereItem> items_;  ///< of the part that is being built
  std::vector<Bounds> above_leaves_;    ///< of the nodes above the leaves
  double mean_radius_ = 0;              ///< box space
  float box_padding_ = 0;
  bool has_rods_ = false, own_radii_ = false;
};

}  // namespace

kernel::Sphere enclosing_sphere(const kernel::Rod& rod) noexcept {
  const double half[3] = {(rod.b[0] - rod.a[0]) / 2, (rod.b[1] - rod.a[1]) / 2, (rod.b[2] - rod.a[2]) / 2};
  return {rod.a[0] + half[0], rod.a[1] + half[1], rod.a[2] + half[2],
          std::hypot(half[0], half[1], half[2]) + rod.radius};
}

SphereBvh::SphereBvh(const BoundedSpheres& spheres, std::vector<std::uint32_t> ids, const BoxFrame& frame,
                     const std::function<bool(double)>& monitor, const BoundedRods& bounded_rods,
                     std::size_t size_of_parts)
    : count(ids.size()) {
  Builder(*this, {spheres, bounded_rods, frame}, std::move(ids))
      .run(monitor, size_of_parts > 0 ? size_of_parts : part_size(count));
}

std::uint64_t SphereBvh::bytes_of_build(const ObjectCounts& objects) noexcept {
  const std::uint64_t count = objects.all(), leaf_count = count / kArity + 1,
                      node_count = leaf_count / (kArity - 1) + 1;
  return leaf_count * (sizeof(Leaf) + (objects.have_one_radius ? 0 : sizeof(LeafRadii)) +
                       (objects.rods > 0 ? sizeof(LeafRods) : 0)) +
         node_count * (sizeof(Node) + sizeof(Cell)) + (count > kMostStartNodes ? 0 : 3 * count) +
         std::min<std::uint64_t>(count, part_size(count)) * sizeof(SphereItem);
}

std::size_t SphereBvh::bytes() const noexcept {
  return start_nodes.bytes() + cells.size() * sizeof(Cell) + leaves.size() * sizeof(Leaf) +
         radii.size() * sizeof(LeafRadii) + rods.size() * sizeof(LeafRods) + nodes.size() * sizeof(Node);
}

}  // namespace orrery::accel
