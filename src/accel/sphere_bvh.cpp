// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_bvh.h"

#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "base/stop_point.h"
#include "math/scalar.h"

namespace orrery::accel {
namespace {

using math::rounded_up;

/// Padding in units of the frame's reach. Derived in docs/decisions/0027-bvh-for-many-spheres.md: rounding moves a
/// ray by at most 40 x 2^-24 relative to a sphere and by at most 19 x 2^-24 relative to a box.
constexpr double kSpherePadding = 0x1.4p-17, kBoxPadding = 0x1p-18;

/// The components of the half axes of rods are -127 to 127 steps.
constexpr double kHalfCodes = 127;

/// Rounding error of the triple product of a ray's direction, the half axis of a rod, and the vector between them, in
/// units of the frame's reach times the length of the half axis: at most 8 x 2^-24 of that vector, whose length is at
/// most 2.5 reaches. The half axis is at most sqrt(3) x 127 steps long.
constexpr double kAxisSlack = 0x1p-18 * 1.7321 * kHalfCodes;

/// Number of leaves that are created before the memory of their items is released, and of items before that of their
/// ids.
constexpr std::size_t kReleasedLeaves = 1 << 16, kReleasedIds = kReleasedLeaves * kArity;

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

/// Returns memory to the operating system. The elements are zero from then on.
template <class T>
void release(T* begin, T* end) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page,
             last = reinterpret_cast<std::uintptr_t>(end) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

/// Quantizes a bound, rounding down and up respectively: the decoded bound is at most, or at least, `bound`.
///
/// Domain     `bound` is between the origin and the decoded value of 255
std::uint8_t code_below(float bound, float origin, float step) {
  int code = std::clamp(static_cast<int>((bound - origin) / step), 0, 255);
  while (code > 0 && std::fma(static_cast<float>(code), step, origin) > bound) --code;
  return static_cast<std::uint8_t>(code);
}
std::uint8_t code_above(float bound, float origin, float step) {
  int code = std::clamp(static_cast<int>((bound - origin) / step), 0, 255);
  while (code < 255 && std::fma(static_cast<float>(code), step, origin) < bound) ++code;
  return static_cast<std::uint8_t>(code);
}

/// The smallest step with which 255 steps from `lower` reach `upper`.
float step_between(float lower, float upper) {
  float step = std::max((upper - lower) / 255, std::numeric_limits<float>::min());
  while (std::fma(255.0F, step, lower) < upper) step = std::nextafter(step * (1 + 0x1p-23F), kInfinity);
  return step;
}

SphereBvh::Node make_node(const Bounds* children, std::size_t count, std::uint32_t first) {
  Bounds all;
  for (std::size_t i = 0; i < count; ++i) all.add(children[i]);
  SphereBvh::Node node{};
  node.first = first;
  node.count = static_cast<std::uint32_t>(count);
  for (int axis = 0; axis < 3; ++axis) {
    const float origin = all.lower[axis], step = step_between(origin, all.upper[axis]);
    node.origin[axis] = origin;
    node.step[axis] = step;
    std::fill_n(node.bound[0][axis], kArity, std::uint8_t{255});
    for (std::size_t i = 0; i < count; ++i) {
      node.bound[0][axis][i] = code_below(children[i].lower[axis], origin, step);
      node.bound[1][axis][i] = code_above(children[i].upper[axis], origin, step);
    }
  }
  return node;
}

SphereBvh::Leaf make_leaf(const SphereItem* items, std::size_t count) {
  Bounds all;
  for (std::size_t i = 0; i < count; ++i) all.add(items[i].center, items[i].center);
  SphereBvh::Leaf leaf{};
  leaf.step = 0;
  for (int axis = 0; axis < 3; ++axis) {
    leaf.origin[axis] = all.lower[axis];
    leaf.step = std::max(leaf.step, step_between(all.lower[axis], all.upper[axis]));
  }
  std::fill_n(leaf.ids, kArity, kernel::kNoSphere);
  for (std::size_t i = 0; i < count; ++i) {
    leaf.ids[i] = items[i].id;
    for (int axis = 0; axis < 3; ++axis)
      leaf.center[axis][i] = static_cast<std::uint8_t>(
          std::clamp(std::lround((items[i].center[axis] - leaf.origin[axis]) / leaf.step), 0L, 255L));
  }
  return leaf;
}

/// A rod's half axis and radius, in box space.
struct RodExtent {
  double half[3], radius;

  RodExtent(const kernel::Rod& rod, const BoxFrame& frame) : radius(rod.radius * frame.scale) {
    for (int axis = 0; axis < 3; ++axis) half[axis] = (rod.b[axis] - rod.a[axis]) / 2 * frame.scale;
  }
};

SphereBvh::LeafRods make_leaf_rods(const SphereBvh::Leaf& leaf, std::size_t count, const BoundedRods& rods,
                                   const BoxFrame& frame) {
  SphereBvh::LeafRods out{};
  const auto each = [&](auto f) {
    for (std::size_t i = 0; i < count; ++i)
      if (rods.rods.contains(leaf.ids[i])) f(i, RodExtent(rods.at(rods.rods.index(leaf.ids[i]), 0), frame));
  };
  double most = 0, thickest = 0, thinnest = std::numeric_limits<double>::infinity();
  each([&](std::size_t i, const RodExtent& rod) {
    out.rods |= 1u << i;
    for (const double x : rod.half) most = std::max(most, std::abs(x));
    thickest = std::max(thickest, rod.radius);
    thinnest = std::min(thinnest, rod.radius);
  });
  if (out.rods == 0) return out;
  out.step = std::max(rounded_up(most / kHalfCodes), std::numeric_limits<float>::min());
  out.radius = rounded_up(thickest);
  out.least_radius = math::rounded_down(thinnest);
  each([&](std::size_t i, const RodExtent& rod) {
    for (int axis = 0; axis < 3; ++axis)
      out.half[axis][i] = static_cast<std::int8_t>(std::lround(rod.half[axis] / out.step));
  });
  return out;
}

}  // namespace

kernel::Sphere enclosing_sphere(const kernel::Rod& rod) noexcept {
  const double half[3] = {(rod.b[0] - rod.a[0]) / 2, (rod.b[1] - rod.a[1]) / 2, (rod.b[2] - rod.a[2]) / 2};
  return {rod.a[0] + half[0], rod.a[1] + half[1], rod.a[2] + half[2],
          std::hypot(half[0], half[1], half[2]) + rod.radius};
}

SphereBvh::SphereBvh(const BoundedSpheres& spheres, std::vector<std::uint32_t> ids, const BoxFrame& frame,
                     const std::function<bool(double)>& monitor, const BoundedRods& bounded_rods)
    : count(ids.size()) {
  using Range = tbb::blocked_range<std::size_t>;
  const std::size_t leaf_count = (count + kArity - 1) / kArity;
  padding = rounded_up(kSpherePadding * frame.reach);
  axis_slack = rounded_up(kAxisSlack * frame.reach);
  const kernel::RodArray& all_rods = bounded_rods.rods;
  const auto enclosing = [&](std::uint32_t id) {
    return all_rods.contains(id) ? enclosing_sphere(bounded_rods.at(all_rods.index(id), 0)) : spheres[id];
  };
  double smallest = std::numeric_limits<double>::infinity(), largest = 0, sum = 0;
  const base::StopPoint stop;
  bool has_rods = false;
  for (const std::uint32_t id : ids) {
    const double r = enclosing(id).radius;
    has_rods = has_rods || all_rods.contains(id);
    smallest = std::min(smallest, r);
    largest = std::max(largest, r);
    sum += r;
  }
  const bool own_radii = smallest < largest || has_rods;
  radius = rounded_up(largest * frame.scale);
  const std::size_t object_count = all_rods.object(*std::max_element(ids.begin(), ids.end())) + 1;

  stop.check();
  using Allocator = base::HugePageAllocator<SphereItem>;
  const auto free_items = [n = count](SphereItem* p) { Allocator().deallocate(p, n); };
  // Its pages are first touched in parallel.
  std::unique_ptr<SphereItem[], decltype(free_items)> storage(Allocator().allocate(count), free_items);
  const std::span<SphereItem> items(storage.get(), count);
  const auto make_items = [&](const Range& range) {
    stop.check();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const kernel::Sphere s = enclosing(ids[i]);
      items[i] = {{static_cast<float>((s.x - frame.middle[0]) * frame.scale),
                   static_cast<float>((s.y - frame.middle[1]) * frame.scale),
                   static_cast<float>((s.z - frame.middle[2]) * frame.scale)},
                  ids[i]};
    }
  };
  for (std::size_t begin = 0; begin < count; begin += kReleasedIds) {
    const std::size_t end = std::min(count, begin + kReleasedIds);
    tbb::parallel_for(Range(begin, end, 4096), make_items);
    release(&ids[begin], &ids[0] + end);
  }
  std::vector<std::uint32_t>().swap(ids);  // copied to the items
  const float box_padding = rounded_up(kBoxPadding * frame.reach);
  const NodeCells node_cells = sort_spheres(items, static_cast<float>(sum / static_cast<double>(count) * frame.scale),
                                            radius + 2 * box_padding, monitor);

  leaves.reserve(leaf_count);
  last_leaf = static_cast<std::uint32_t>(leaf_count - 1);
  no_start_node = static_cast<std::uint32_t>((leaf_count + kArity - 1) / kArity);
  start_nodes = base::PackedArray(object_count, no_start_node);
  if (own_radii) radii.reserve(leaf_count);
  if (has_rods) rods.reserve(leaf_count);
  std::vector<Bounds> below;
  below.reserve(leaf_count);
  const auto make_leaves = [&](const Range& range) {
    for (std::size_t l = range.begin(); l < range.end(); ++l) {
      const std::size_t n = count_in(static_cast<std::uint32_t>(l));
      const SphereItem* const in_leaf = &items[l * kArity];
      leaves[l] = make_leaf(in_leaf, n);
      float r[kArity], most = 0;
      for (std::size_t i = 0; i < n; ++i) {
        start_nodes.set(all_rods.object(in_leaf[i].id), static_cast<std::uint32_t>(l / kArity));
        r[i] = own_radii ? rounded_up(enclosing(in_leaf[i].id).radius * frame.scale) : radius;
        most = std::max(most, r[i]);
        float reach[3] = {r[i], r[i], r[i]}, lower[3], upper[3];
        if (all_rods.contains(in_leaf[i].id)) {
          const RodExtent rod(bounded_rods.at(all_rods.index(in_leaf[i].id), 0), frame);
          for (int axis = 0; axis < 3; ++axis) reach[axis] = rounded_up(std::abs(rod.half[axis]) + rod.radius);
        }
        for (int axis = 0; axis < 3; ++axis) {
          lower[axis] = in_leaf[i].center[axis] - (reach[axis] + box_padding);
          upper[axis] = in_leaf[i].center[axis] + (reach[axis] + box_padding);
        }
        below[l].add(lower, upper);
      }
      if (!own_radii) continue;
      radii[l].step = step_between(0, most);
      for (std::size_t i = 0; i < n; ++i) radii[l].radius[i] = code_above(r[i], 0, radii[l].step);
      if (has_rods) rods[l] = make_leaf_rods(leaves[l], n, bounded_rods, frame);
    }
  };
  // Leaves replace items step by step, so that both are never in memory completely.
  for (std::size_t begin = 0; begin < leaf_count; begin += kReleasedLeaves) {
    stop.check();
    const std::size_t end = std::min(leaf_count, begin + kReleasedLeaves);
    leaves.resize(end);
    if (own_radii) radii.resize(end);
    if (has_rods) rods.resize(end);
    below.resize(end);
    tbb::parallel_for(Range(begin, end, 256), make_leaves);
    release(&items[begin * kArity], &items[0] + std::min(count, end * kArity));
  }
  storage.reset();

  std::uint32_t first = 0;
  std::size_t level = 0;
  for (bool of_leaves = true; of_leaves || below.size() > 1; of_leaves = false) {
    const std::size_t parents = (below.size() + kArity - 1) / kArity, begin = nodes.size();
    std::vector<Bounds> above(parents);
    nodes.resize(begin + parents);
    tbb::parallel_for(Range(0, parents, 64), [&](const Range& range) {
      for (std::size_t p = range.begin(); p < range.end(); ++p) {
        const std::size_t n = std::min<std::size_t>(kArity, below.size() - p * kArity);
        const auto child = static_cast<std::uint32_t>(first + p * kArity);
        nodes[begin + p] = make_node(&below[p * kArity], n, of_leaves ? child | kLeafBit : child);
        for (std::size_t i = 0; i < n; ++i) above[p].add(below[p * kArity + i]);
      }
    });
    cells.insert(cells.end(), node_cells[level].begin(), node_cells[level].end());
    level_begin[level++] = first = static_cast<std::uint32_t>(begin);
    below = std::move(above);
  }
  std::copy_n(below[0].lower, 3, box.lower);
  std::copy_n(below[0].upper, 3, box.upper);
}

std::size_t SphereBvh::bytes() const noexcept {
  return start_nodes.bytes() + cells.size() * sizeof(Cell) + leaves.size() * sizeof(Leaf) +
         radii.size() * sizeof(LeafRadii) + rods.size() * sizeof(LeafRods) + nodes.size() * sizeof(Node);
}

}  // namespace orrery::accel
